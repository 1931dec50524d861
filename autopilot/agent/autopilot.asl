// The autopilot: what the drone does, and when.
//
// It runs once every 30 ms. Each run takes one event, finds the first plan for it whose context
// holds, and carries the plan out to its end. Every plan issues exactly one AT command, so the
// drone hears from us in every step.
//
// The environment tells where the drone is and how it is (`position`, `battery`, `blindFor`,
// `doubt`, `wind`) and how orders are to be flown (`reachDistance`, `stayDistance`, `stayTime`); it
// orders `takeOff`, `goTo`, `hold`, `steer` and `land`. The last three pre-empt whatever runs.

// ---- Limits. Change them with care.

// Charge at which the pilot is warned, and at which the drone lands. Percent.
warningBattery(20).
landingBattery(12).
// Without believable navdata the drone holds still after this, and lands after that. Milliseconds.
holdWhenBlind(300).
landWhenBlind(2000).
// A place that is known no better than this is no place to fly by. Metres.
largestDoubt(3.0).
// Wind against which there is no holding: a share of what full tilt gives.
strongestWind(0.7).
// The drone's own landing drifts with the wind. Where it blows like this, we first come down by
// ourselves to this height, in metres, but not for longer than this, in milliseconds.
landingWind(0.1).
landingHeight(0.35).
comingDownTime(8000).
// A take-off that takes longer than this has failed; a target that is not reached in this time is
// given up. Milliseconds.
takeOffTime(10000).
approachTime(60000).

!wait.

// ---- Watching over the flight. Every plan in the air asks this first. Where flying on is no
// longer safe, the reason is told and the plan fails: the failure plans land.

@empty_battery[req("SAF-4")]
+!watch : battery(Percent) & landingBattery(Limit) & Percent <= Limit
  <- tellBatteryEmpty;
     ?airworthy.

@blind[req("SAF-5")]
+!watch : blindFor(Time) & landWhenBlind(Limit) & Time > Limit
  <- tellBlind;
     ?airworthy.

@lost[req("SAF-5")]
+!watch : doubt(Metres) & largestDoubt(Limit) & Metres > Limit
  <- tellLost;
     ?airworthy.

@strong_wind[req("SAF-5")]
+!watch : wind(Share) & strongestWind(Limit) & Share > Limit
  <- tellWind;
     ?airworthy.

@low_battery[req("SAF-4")]
+!watch : battery(Percent) & warningBattery(Limit) & Percent <= Limit & not batteryWarned
  <- +batteryWarned;
     tellBatteryLow.

+!watch.

// ---- Waiting for an order: stay where we are.

+!wait : onGround
  <- sendStandby;
     !!wait.

+!wait : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !!wait.

+!wait : target(X, Y, Z, Yaw)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     !!wait.

+!wait
  <- !watch;
     sendHover;
     !!wait.

@danger_waiting[req("SAF-4"), req("SAF-5")]
-!wait <- sendHover; !land.

// ---- Taking off. The drone climbs by itself; it is done when it says that it hovers.
// The place where it then is becomes the target to hold.

@no_charge_to_take_off[req("SAF-4")]
+!takeOff : onGround & battery(Percent) & landingBattery(Limit) & Percent <= Limit
  <- reportRefused;
     sendStandby;
     !!wait.

@take_off[req("SAF-3")]
+!takeOff : onGround
  <- -target(_, _, _, _);
     sendTakeOff;
     Start = getCurrentTimeMS;
     !completeTakeOff(Start).

// In the air already: take over where the drone is.
+!takeOff : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

// In the air and no idea where: hold still.
+!takeOff
  <- !watch;
     sendHover;
     reportFailed;
     !!wait.

@danger_taking_over[req("SAF-4"), req("SAF-5")]
-!takeOff <- sendHover; !land.

+!completeTakeOff(_) : hovering & position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!completeTakeOff(Start) : takeOffTime(Limit) & longEnough(Start, Limit)
  <- sendLand;
     reportFailed;
     !completeLand.

@still_taking_off[req("SAF-3")]
+!completeTakeOff(Start)
  <- !watch;
     sendTakeOff;
     !completeTakeOff(Start).

@danger_taking_off[req("SAF-4"), req("SAF-5")]
-!completeTakeOff(_) <- sendHover; !land.

// ---- Going somewhere: approach until close enough, then stay a while.

+!goTo(_, _, _, _) : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

+!goTo(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     Start = getCurrentTimeMS;
     !approach(Start).

+!approach(_) : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

+!approach(Start) : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !approach(Start).

+!approach(Start) : approachTime(Limit) & longEnough(Start, Limit)
  <- -target(_, _, _, _);
     tellNoProgress;
     sendLand;
     !completeLand.

+!approach(Start) : target(X, Y, Z, Yaw) & reachDistance(Distance) & closeEnough(X, Y, Z, Yaw, Distance)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     Arrival = getCurrentTimeMS;
     !stay(Start, Arrival).

+!approach(Start) : target(X, Y, Z, Yaw)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     !approach(Start).

@danger_approaching[req("SAF-4"), req("SAF-5")]
-!approach(_) <- sendHover; !land.

+!stay(Start, Arrival) : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !stay(Start, Arrival).

// Drifted off: approach again, and the stay begins anew.
+!stay(Start, _) : target(X, Y, Z, Yaw) & stayDistance(Distance) & not closeEnough(X, Y, Z, Yaw, Distance)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     !approach(Start).

+!stay(_, Arrival) : target(X, Y, Z, Yaw) & stayTime(Time) & longEnough(Arrival, Time)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!stay(Start, Arrival) : target(X, Y, Z, Yaw)
  <- !watch;
     sendGoto(X, Y, Z, Yaw);
     !stay(Start, Arrival).

@danger_staying[req("SAF-4"), req("SAF-5")]
-!stay(_, _) <- sendHover; !land.

// ---- The pilot's hand. Hold where we are, until told otherwise.

+!hold : onGround
  <- sendStandby;
     !!wait.

+!hold : position(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !!wait.

+!hold
  <- -target(_, _, _, _);
     sendHover;
     !!wait.

// As the sticks say, as long as they are moved.
+!steer : onGround
  <- sendStandby;
     !!wait.

+!steer : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !!wait.

+!steer : steering
  <- !watch;
     sendSticks;
     !steer.

+!steer : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !!wait.

+!steer
  <- !watch;
     sendHover;
     !!wait.

@danger_steering[req("SAF-4"), req("SAF-5")]
-!steer <- sendHover; !land.

// ---- Landing: where it blows by ourselves as far as we can, with eyes open; then by the drone.

@landed_already[req("SAF-2")]
+!land : onGround
  <- sendStandby;
     reportDone;
     !!wait.

@land_in_wind[req("SAF-2")]
+!land : wind(Share) & landingWind(Breeze) & Share > Breeze
    & blindFor(Time) & holdWhenBlind(Patience) & Time <= Patience
    & position(X, Y, Z, Yaw) & landingHeight(Low) & Z > Low
  <- +target(X, Y, Low, Yaw);
     sendDescent(X, Y, Low, Yaw);
     Start = getCurrentTimeMS;
     !descend(Start).

@land[req("SAF-2")]
+!land
  <- -target(_, _, _, _);
     sendLand;
     !completeLand.

@landed_descending[req("SAF-2")]
+!descend(_) : onGround
  <- sendStandby;
     reportDone;
     !!wait.

@too_long_descending[req("SAF-2")]
+!descend(Start) : comingDownTime(Limit) & longEnough(Start, Limit)
  <- -target(_, _, _, _);
     sendLand;
     !completeLand.

// Blind for a moment, and charge enough to wait for it to pass.
@blind_descending[req("SAF-2")]
+!descend(Start) : blindFor(Time) & holdWhenBlind(Patience) & Time > Patience
    & landWhenBlind(Limit) & Time <= Limit
    & not (battery(Percent) & landingBattery(Least) & Percent <= Least)
  <- sendHover;
     !descend(Start).

@descend[req("SAF-2")]
+!descend(Start) : blindFor(Time) & holdWhenBlind(Patience) & Time <= Patience
    & target(X, Y, Z, Yaw) & position(_, _, Height, _) & Height > Z + 0.1
  <- sendDescent(X, Y, Z, Yaw);
     !descend(Start).

@low_enough[req("SAF-2")]
+!descend(_)
  <- -target(_, _, _, _);
     sendLand;
     !completeLand.

// The order is repeated until the drone says that it has landed.
@landed[req("SAF-2")]
+!completeLand : onGround
  <- sendStandby;
     reportDone;
     !!wait.

@still_landing[req("SAF-2")]
+!completeLand
  <- sendLand;
     !completeLand.
