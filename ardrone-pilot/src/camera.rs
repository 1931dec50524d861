//! Names of the cameras in JSON.

use ardrone_link::settings::Camera;
use serde::{Deserialize, Serialize};

/// A camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum NamedCamera {
    Front,
    Bottom,
}

impl From<NamedCamera> for Camera {
    fn from(camera: NamedCamera) -> Self {
        match camera {
            NamedCamera::Front => Self::Front,
            NamedCamera::Bottom => Self::Bottom,
        }
    }
}

impl From<Camera> for NamedCamera {
    fn from(camera: Camera) -> Self {
        match camera {
            Camera::Front => Self::Front,
            Camera::Bottom => Self::Bottom,
        }
    }
}
