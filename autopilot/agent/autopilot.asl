// The autopilot: what the drone does, and when.
//
// It runs once every 30 ms. Each run takes one event, finds the first plan for it whose context
// holds, and carries the plan out to its end. Every plan issues exactly one AT command, so the
// drone hears from us in every step.
//
// The environment tells where the drone is (`position`) and how orders are to be flown
// (`reachDistance`, `stayDistance`, `stayTime`); it orders `takeOff`, `goTo` and `land`.

// A take-off that takes longer than this has failed. Milliseconds.
takeOffTime(10000).

!wait.

// ---- Waiting for an order: stay where we are.

+!wait : onGround
  <- sendStandby;
     !!wait.

+!wait : target(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !!wait.

+!wait
  <- sendHover;
     !!wait.

// ---- Taking off. The drone climbs by itself; it is done when it says that it hovers.
// The place where it then is becomes the target to hold.

+!takeOff : onGround
  <- -target(_, _, _, _);
     sendTakeOff;
     Start = getCurrentTimeMS;
     !completeTakeOff(Start).

// In the air already: take over where the drone is.
+!takeOff : position(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

// In the air and no idea where: hold still.
+!takeOff
  <- sendHover;
     reportFailed;
     !!wait.

+!completeTakeOff(_) : hovering & position(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!completeTakeOff(Start) : takeOffTime(Limit) & longEnough(Start, Limit)
  <- sendLand;
     reportFailed;
     !completeLand.

+!completeTakeOff(Start)
  <- sendTakeOff;
     !completeTakeOff(Start).

// ---- Going somewhere: approach until close enough, then stay a while.

+!goTo(_, _, _, _) : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

+!goTo(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !approach.

+!approach : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

+!approach : target(X, Y, Z, Yaw) & reachDistance(Distance) & closeEnough(X, Y, Z, Yaw, Distance)
  <- sendGoto(X, Y, Z, Yaw);
     Arrival = getCurrentTimeMS;
     !stay(Arrival).

+!approach : target(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !approach.

// Nowhere to go: hold still.
+!approach
  <- sendHover;
     reportFailed;
     !!wait.

// Drifted off: approach again, and the stay begins anew.
+!stay(_) : target(X, Y, Z, Yaw) & stayDistance(Distance) & not closeEnough(X, Y, Z, Yaw, Distance)
  <- sendGoto(X, Y, Z, Yaw);
     !approach.

+!stay(Arrival) : target(X, Y, Z, Yaw) & stayTime(Time) & longEnough(Arrival, Time)
  <- sendGoto(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!stay(Arrival) : target(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !stay(Arrival).

+!stay(_)
  <- sendHover;
     reportFailed;
     !!wait.

// ---- Landing. The order is repeated until the drone says that it has landed.

+!land : onGround
  <- sendStandby;
     reportDone;
     !!wait.

+!land
  <- -target(_, _, _, _);
     sendLand;
     !completeLand.

+!completeLand : onGround
  <- sendStandby;
     reportDone;
     !!wait.

+!completeLand
  <- sendLand;
     !completeLand.
