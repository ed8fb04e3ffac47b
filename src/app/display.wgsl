// Shows the picture, one framebuffer pixel at a time: exposure, tone curve and sRGB coding, or one
// number a pixel as a color of a ramp.
// The curve mirrors src/image/tone.rs; a test holds the two against each other.

struct View {
    // Picture position, in picture pixels, of the framebuffer's upper left corner.
    origin: vec2f,
    // Picture pixels per framebuffer pixel.
    step: f32,
    // Linear factor.
    exposure: f32,
    // Size of the picture in pixels; zero where there is none yet.
    size: vec2u,
    // 0: linear, 1: filmic, 2: the ramp.
    curve: u32,
    // 1 where the framebuffer does not code sRGB by itself.
    encode: u32,
    // What lies around the picture, linear.
    surround: vec4f,
    // Logarithm of the number at the ramp's start, and one over that of the ratio of its ends.
    scale: vec4f,
    // The ramp, linear.
    ramp: array<vec4f, 17>,
};

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var picture: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // One triangle that covers the viewport.
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// The mean of the picture over the framebuffer pixel at `center` (picture pixels): the nearest
// texel when zoomed in, up to 6 x 6 of them when zoomed out.
fn footprint(center: vec2f) -> vec3f {
    let last = vec2i(view.size) - 1;
    let taps = clamp(i32(ceil(view.step - 0.001)), 1, 6);
    if taps == 1 {
        return textureLoad(picture, clamp(vec2i(floor(center)), vec2i(0), last), 0).rgb;
    }
    let low = center - 0.5 * view.step;
    var sum = vec3f(0.0);
    for (var y = 0; y < taps; y++) {
        for (var x = 0; x < taps; x++) {
            let at = low + (vec2f(f32(x), f32(y)) + 0.5) * view.step / f32(taps);
            sum += textureLoad(picture, clamp(vec2i(floor(at)), vec2i(0), last), 0).rgb;
        }
    }
    return sum / f32(taps * taps);
}


// The tone curve, from exposed linear values to display-linear ones.
fn tone(color: vec3f) -> vec3f {
    if view.curve == 0u {
        return color;
    }
    let x = clamp(color, vec3f(0.0), vec3f(1.0e4));
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// The color of a number on the ramp; black for none at all.
fn ramp(value: f32) -> vec3f {
    if value <= 0.0 {
        return vec3f(0.0);
    }
    var place = 1.0;
    if view.scale.y > 0.0 {
        place = clamp((log(value) - view.scale.x) * view.scale.y, 0.0, 1.0);
    }
    let at = place * 16.0;
    let low = min(u32(at), 15u);
    return mix(view.ramp[low].rgb, view.ramp[low + 1u].rgb, at - f32(low));
}

fn srgb(linear: vec3f) -> vec3f {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3f(0.0031308));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = view.origin + position.xy * view.step;
    var color = view.surround.rgb;
    if all(at >= vec2f(0.0)) && all(at < vec2f(view.size)) {
        if view.curve == 2u {
            color = ramp(footprint(at).r);
        } else {
            color = tone(footprint(at) * view.exposure);
        }
    }
    color = clamp(color, vec3f(0.0), vec3f(1.0));
    if view.encode == 1u {
        color = srgb(color);
    }
    return vec4f(color, 1.0);
}
