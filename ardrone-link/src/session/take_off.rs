//! The take-off bit, which no old order may raise again.

use super::FlightOrder;

/// State of the take-off bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TakeOffLatch {
    /// The bit follows the orders.
    Follow { airborne: bool },
    /// An event has invalidated all older orders: the bit stays down until landing and then take-off are
    /// ordered again.
    Withheld { landing_ordered: bool },
}

impl Default for TakeOffLatch {
    fn default() -> Self {
        Self::Follow { airborne: false }
    }
}

impl TakeOffLatch {
    /// Invalidates all orders given so far.
    pub(super) fn withhold(&mut self) {
        *self = Self::Withheld { landing_ordered: false };
    }

    /// Takes in the drone's state: whether it flies, and whether it reports that it has landed.
    pub(super) fn observe(&mut self, flying: bool, landed: bool) {
        let Self::Follow { airborne } = *self else { return };
        if flying {
            *self = Self::Follow { airborne: true };
        } else if airborne && landed {
            // It has flown and landed: the order to fly is used up.
            self.withhold();
        }
    }

    /// The bit for a tick with this order.
    pub(super) fn bit(&mut self, order: FlightOrder) -> bool {
        match self {
            Self::Follow { airborne } => match order {
                FlightOrder::TakeOff => true,
                FlightOrder::StayAirborne => *airborne,
                FlightOrder::Land => false,
            },
            Self::Withheld { landing_ordered } => {
                let renewed = *landing_ordered && order == FlightOrder::TakeOff;
                *landing_ordered |= order == FlightOrder::Land;
                if renewed {
                    *self = Self::Follow { airborne: false };
                }
                renewed
            }
        }
    }
}
