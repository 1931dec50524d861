// A rover that visits points, backs away from what is in its way, gives up after three attempts, and stops where it would
// fall over or run out of charge.

reserve(30).

!wait.

// ---- What every step asks first. A goal that fails here ends in safe mode by its failure plan.

+!wait : tilt(Angle) & Angle > 25.0 <- safeMode; !!wait.
+!wait : charge(Now) & reserve(Least) & Now < Least <- safeMode; !!wait.
+!wait <- halt; !!wait.

+!visit(_, _) : tilt(Angle) & Angle > 25.0 <- safeMode.
+!visit(_, _) : charge(Now) & reserve(Least) & Now < Least <- safeMode.
+!visit(X, Y) <- halt; !drive(X, Y, 3).

@tilted[req("ROV-2")]
+!drive(_, _, _) : tilt(Angle) & Angle > 25.0 <- safeMode.
@empty[req("ROV-4")]
+!drive(_, _, _) : charge(Now) & reserve(Least) & Now < Least <- safeMode.
@blocked[req("ROV-3")]
+!drive(X, Y, Attempts) : obstacle(Metres) & Metres < 0.5
  <- Left = Attempts - 1; halt; !avoid(X, Y, Left).
+!drive(X, Y, _) : isThere(X, Y) <- halt.
+!drive(X, Y, Attempts) <- driveTo(X, Y); !drive(X, Y, Attempts).
// What cannot be counted further is not tried again. It is counted before the command is sent: else there were two.
-!drive(_, _, _) <- safeMode.

+!avoid(_, _, _) : tilt(Angle) & Angle > 25.0 <- safeMode.
+!avoid(_, _, _) : charge(Now) & reserve(Least) & Now < Least <- safeMode.
+!avoid(_, _, Attempts) : Attempts < 1 <- halt.
+!avoid(X, Y, Attempts) <- backUp; !drive(X, Y, Attempts).

@halt[req("ROV-5")]
+!halt_now : tilt(Angle) & Angle > 25.0 <- safeMode; !!wait.
+!halt_now : charge(Now) & reserve(Least) & Now < Least <- safeMode; !!wait.
+!halt_now <- halt; !!wait.
