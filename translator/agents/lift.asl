// A lift that rides to the floor to which it is called. Each step says exactly one thing to the motor.

!idle.

+!idle <- motorStop; !!idle.

// ---- A call is served to its end before the next one.

@out_of_order[req("LIFT-3")]
+!call(_) : stopped <- motorStop.

+!call(To) <- motorStop; closeDoor; !drive(To).

// An open door comes before everything else, also half way.
@door[req("LIFT-2")]
+!drive(To) : doorGap(Gap) & Gap > 0 <- motorStop; closeDoor; !drive(To).

+!drive(To) : floor(At) & At < To <- motorUp; !drive(To).
+!drive(To) : floor(At) & At > To <- motorDown; !drive(To).
+!drive(To) : floor(To) <- motorStop; openDoor.
// Where the cabin is, is not known.
+!drive(To) <- motorStop; !drive(To).

// ---- The red button drops whatever runs, in the first step even `!idle`. No call is taken until somebody has looked.

@red_button[req("LIFT-3")]
+!emergency <- +stopped; motorStop; !!idle.
+!reset <- -stopped; motorStop.
