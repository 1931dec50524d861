//! Orders that programs and pages send: JSON objects like `{"order":"hold"}`.

use autopilot::plan::{FlightLimits, PlanError, TagUse};
use autopilot::vehicle::{OperatorOrder, OrderText, VehicleName};
use serde::Deserialize as _;
use serde_json::Value;

/// Why a text is no order.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ReadError {
    /// There is no such order, or something is missing.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The order has no use for this.
    #[error("unknown field `{}`", .0.escape_debug())]
    Unknown(String),
    /// It is for another vehicle.
    #[error("it is for the vehicle {ordered}, and this is {here:?}")]
    Elsewhere {
        /// The vehicle that it names.
        ordered: Value,
        /// This one.
        here: VehicleName,
    },
    /// The plan cannot be flown, or there are no such commands.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// Takes the name of the vehicle out of a request, which may leave it out.
///
/// # Errors
/// [`ReadError::Elsewhere`] if it names another vehicle.
pub(crate) fn take_vehicle(request: &mut Value, here: VehicleName) -> Result<(), ReadError> {
    match request.as_object_mut().and_then(|request| request.remove("vehicle")) {
        Some(ordered) if ordered != here.as_str() => Err(ReadError::Elsewhere { ordered, here }),
        _ => Ok(()),
    }
}

/// Reads an order.
///
/// # Errors
/// [`ReadError`] if it is none.
pub(crate) fn read(
    object: &Value,
    limits: &FlightLimits,
    tags: TagUse<'_>,
) -> Result<OperatorOrder, ReadError> {
    let text = OrderText::deserialize(object)?;
    // What an order has no use for may be meant for another one.
    let known = serde_json::to_value(&text)?;
    let mut keys = object.as_object().into_iter().flat_map(serde_json::Map::keys);
    if let Some(odd) = keys.find(|key| known.get(key).is_none()) {
        return Err(ReadError::Unknown(odd.clone()));
    }
    Ok(text.parse(limits, tags)?)
}
