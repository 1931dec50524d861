// The autopilot of the paper, for comparison: Bucheli, Kroening, Martins, Natraj, "From AgentSpeak to C
// for Safety Considerations in Unmanned Aerial Vehicles" (TAROS 2015), figures 1 and 2.
//
// Its goals and what each of its plans does are the original's; the words are ours. It is not what
// flies: docs/verification.md tells which of the promises of our autopilot it would keep.

!waitForCommand.

// ---- Waiting for a command: hold the last target, or else the place where the drone is. On the ground
// the original sends nothing, which is what `standBy` does: so every step can be asked for a command.

+!waitForCommand : onGround
  <- standBy;
     !!waitForCommand.

+!waitForCommand : lastTarget(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !!waitForCommand.

+!waitForCommand
  <- ?position(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !!waitForCommand.

// ---- Taking off.

+!takeOff : onGround
  <- sendTakeOff;
     Start = getCurrentTimeMS;
     !completeTakeOff(Start).

+!completeTakeOff(Start) : not longEnough(Start, 5000)
  <- sendTakeOff;
     !completeTakeOff(Start).

+!completeTakeOff(Start) : longEnough(Start, 5000)
  <- sendHover;
     !!waitForCommand.

// ---- Going to a target, and staying there for a while.

+!goTo(X, Y, Z, Yaw) : not onGround
  <- +lastTarget(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !completeGoTo(X, Y, Z, Yaw).

+!completeGoTo(X, Y, Z, Yaw) : position(_, _, _, _) & not closeEnough(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !completeGoTo(X, Y, Z, Yaw).

// The target is reached for the first time.
+!completeGoTo(X, Y, Z, Yaw) : position(_, _, _, _) & closeEnough(X, Y, Z, Yaw)
  <- Start = getCurrentTimeMS;
     !stayAtTarget(Start, X, Y, Z, Yaw).

+!stayAtTarget(_, X, Y, Z, Yaw) : not closeEnough(X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !completeGoTo(X, Y, Z, Yaw).

+!stayAtTarget(Start, X, Y, Z, Yaw) : not longEnough(Start, 3000)
  <- sendGoto(X, Y, Z, Yaw);
     !stayAtTarget(Start, X, Y, Z, Yaw).

+!stayAtTarget(_, X, Y, Z, Yaw)
  <- sendGoto(X, Y, Z, Yaw);
     !!waitForCommand.

// ---- Landing.

+!land : not onGround
  <- sendLand;
     !completeLand.

+!completeLand : not onGround
  <- sendLand;
     !completeLand.

+!completeLand : onGround
  <- standBy;
     !!waitForCommand.
