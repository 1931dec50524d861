//! Refused requests, and the parameters of requests.

use lsp_server::ErrorCode;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Why a request has no result.
#[derive(Debug)]
pub(super) struct Refusal {
    pub(super) code: ErrorCode,
    pub(super) message: String,
}

impl Refusal {
    /// A request that makes no sense for this text.
    pub(super) fn because(message: impl Into<String>) -> Self {
        Self { code: ErrorCode::RequestFailed, message: message.into() }
    }

    /// A method that the server does not have.
    pub(super) fn unknown(method: &str) -> Self {
        let message = format!("unknown method `{method}`");
        Self { code: ErrorCode::MethodNotFound, message }
    }

    fn parameters(error: &serde_json::Error) -> Self {
        Self { code: ErrorCode::InvalidParams, message: error.to_string() }
    }
}

pub(super) type Answer = Result<Value, Refusal>;

/// The parameters of a request or notification.
pub(super) fn parameters<T: DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    serde_json::from_value(params).map_err(|error| Refusal::parameters(&error))
}

/// A result; `null` if there is none.
pub(super) fn result<T: Serialize>(result: T) -> Answer {
    serde_json::to_value(result)
        .map_err(|error| Refusal { code: ErrorCode::InternalError, message: error.to_string() })
}
