//! The order of the rooms, the lowest layer first. A new file belongs to one of these rooms or is
//! given a place here.

use crate::order::Order;

/// All orders that hold.
pub const ORDERS: [Order; 3] = [ROOMS, TRANSPORT, APP];

/// The rooms of the package; `src/lib.rs` draws the same map.
const ROOMS: Order = Order {
    folder: "src",
    layers: &[
        &["error", "format", "math"],
        &["files", "sampling"],
        &["surface", "volume"],
        &["light"],
        &["transport"],
        &["render"],
        &["image"],
        &["scene"],
        &["app"],
        &["cli"],
        &["lib", "main"],
    ],
};

/// How light moves, from single collisions up to whole paths and the frame that runs them.
const TRANSPORT: Order = Order {
    folder: "src/transport",
    layers: &[
        &["camera", "learned_counts", "strategy", "vertex", "weight_window"],
        &["observer", "spending", "toggle", "tracking"],
        &["effective"],
        &["scene"],
        &["emission/ray", "transmittance"],
        &["march", "shadow"],
        &["emission"],
        &["direct"],
        &["probes"],
        &["context"],
        &["path_setup"],
        &["sample"],
        &["counts"],
        &["distance"],
        &["guiding"],
        &["path"],
        &["prepare"],
        &["frame"],
        &["profile"],
        &["mod"],
    ],
};

/// The window, from the commands up to the shell that shows all panels.
const APP: Order = Order {
    folder: "src/app",
    layers: &[
        &["command"],
        &["ui"],
        &["document"],
        &["jobs"],
        &["picture"],
        &["compare"],
        &["sweep"],
        &["snapshots", "time_line"],
        &["diagnostics"],
        &["panels"],
        &["shell"],
        &["mod"],
    ],
};
