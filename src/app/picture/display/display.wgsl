// Draws the picture on a canvas, one framebuffer pixel at a time: exposure, tone curve and sRGB
// coding, or one number a pixel as a color of a ramp. And copies that to the window.
// Balance, curves and false color mirror src/image/tone; a test holds them against each other.

// What is settled for a whole picture when its pipeline is made.

// 0: linear, 1: filmic, 2: the ramp, 3: AgX, 4: none, the picture is of codes, which go through.
override CURVE: u32;
// 0: color, 1 to 3: red, green, blue, 4: luminance, 5: false color.
override CHANNEL: u32;
// Whether a framebuffer pixel covers more than one of the picture.
override IS_SHRUNK: bool;
// Whether lines are drawn between pixels.
override HAS_GRID: bool;
// Whether the framebuffer does not code sRGB by itself.
override ENCODES: bool;

struct View {
    // Picture position, in picture pixels, of the framebuffer's upper left corner.
    origin: vec2f,
    // Picture pixels per framebuffer pixel.
    step: f32,
    // Blocks of 2 to this power pixels squared are a texel each.
    block_log2: u32,
    // Size of the picture in pixels; zero where there is none yet.
    size: vec2u,
    // The framebuffer's pixel where the canvas begins.
    canvas: vec2i,
    // What lies around the picture, linear, or its codes around codes.
    surround: vec4f,
    // Logarithm of the number at the ramp's start, and one over that of the ratio of its ends.
    scale: vec4f,
    // White balance and exposure, column by column.
    exposed_from_linear: array<vec4f, 3>,
    // The ramp or the colors of stops, linear.
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

// The pixel at `at`, or that of the picture next to it.
fn pixel(at: vec2f, last: vec2i) -> vec3f {
    let texel = clamp(vec2i(floor(at)), vec2i(0), last) >> vec2u(view.block_log2);
    return textureLoad(picture, texel, 0).rgb;
}

// The mean of the picture over the framebuffer pixel at `center` (picture pixels): the nearest
// texel when zoomed in, up to 6 x 6 of them when zoomed out.
fn footprint(center: vec2f) -> vec3f {
    let last = vec2i(view.size) - 1;
    if !IS_SHRUNK {
        return pixel(center, last);
    }
    let taps = clamp(i32(ceil(view.step - 0.001)), 2, 6);
    let low = center - 0.5 * view.step;
    var sum = vec3f(0.0);
    for (var y = 0; y < taps; y++) {
        for (var x = 0; x < taps; x++) {
            let at = low + (vec2f(f32(x), f32(y)) + 0.5) * view.step / f32(taps);
            sum += pixel(at, last);
        }
    }
    return sum / f32(taps * taps);
}


fn agx(color: vec3f) -> vec3f {
    let inset = mat3x3f(
        vec3f(0.8424791, 0.04232824, 0.04237566),
        vec3f(0.0784336, 0.8784686, 0.0784336),
        vec3f(0.079223745, 0.07916613, 0.87914297),
    );
    let outset = mat3x3f(
        vec3f(1.196879, -0.05289685, -0.052971635),
        vec3f(-0.09802088, 1.1519031, -0.09804345),
        vec3f(-0.09902974, -0.09896118, 1.1510737),
    );
    let stops = log2(max(inset * color, vec3f(1.0e-10)));
    let x = (clamp(stops, vec3f(-12.47393), vec3f(4.026069)) + 12.47393) / 16.499999;
    var curved = vec3f(15.5);
    curved = curved * x - 40.14;
    curved = curved * x + 31.96;
    curved = curved * x - 6.868;
    curved = curved * x + 0.4298;
    curved = curved * x + 0.1191;
    curved = curved * x - 0.00232;
    return pow(clamp(outset * curved, vec3f(0.0), vec3f(1.0)), vec3f(2.2));
}

// What of an exposed color is shown: all of it, or one channel of it as gray.
fn channel_of(color: vec3f) -> vec3f {
    switch CHANNEL {
        case 1u: { return color.rrr; }
        case 2u: { return color.ggg; }
        case 3u: { return color.bbb; }
        case 4u: { return vec3f(luminance(color)); }
        default: { return color; }
    }
}

fn luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}

// The color of the stop that a luminance is from middle gray.
fn false_color(luminance: f32) -> vec3f {
    let stop = round(log2(max(luminance, 1.0e-37) / 0.18));
    return view.ramp[u32(clamp(stop + 8.0, 0.0, 16.0))].rgb;
}

// White balance, exposure and curve.
fn shown(color: vec3f) -> vec3f {
    let columns = view.exposed_from_linear;
    let balance = mat3x3f(columns[0].rgb, columns[1].rgb, columns[2].rgb);
    let exposed = balance * clamp(color, vec3f(-1.0e20), vec3f(1.0e20));
    if CHANNEL == 5u {
        return false_color(luminance(exposed));
    }
    return tone(channel_of(exposed));
}

// The tone curve, from exposed linear values to display-linear ones.
fn tone(color: vec3f) -> vec3f {
    if CURVE == 0u {
        return color;
    }
    let x = clamp(color, vec3f(0.0), vec3f(1.0e4));
    if CURVE == 3u {
        return agx(x);
    }
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
    let at = view.origin + (position.xy + vec2f(view.canvas)) * view.step;
    var color = view.surround.rgb;
    if all(at >= vec2f(0.0)) && all(at < vec2f(view.size)) {
        if CURVE == 2u {
            color = ramp(footprint(at).r);
        } else if CURVE == 4u {
            color = footprint(at);
        } else {
            color = shown(footprint(at));
        }
        // Lines between pixels that are large enough.
        if HAS_GRID && any(fract(at) < vec2f(view.step)) {
            color = mix(clamp(color, vec3f(0.0), vec3f(1.0)), vec3f(0.05), 0.5);
        }
    }
    color = clamp(color, vec3f(0.0), vec3f(1.0));
    if ENCODES && CURVE != 4u {
        color = srgb(color);
    }
    return vec4f(color, 1.0);
}

// The canvas, pixel by pixel.
@fragment
fn copy(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(picture, vec2i(position.xy) - view.canvas, 0);
}
