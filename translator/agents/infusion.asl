// An infusion pump: it runs, stops and alarms where the line is blocked or has air in it, and can be
// silenced for a few steps by who stands beside it.

!rest.

@air_at_rest[req("PUMP-3"), req("PUMP-4")]
+!rest : air(Air) & Air > 50 <- stopMotor; alarm; !!rest.
@blocked_at_rest[req("PUMP-2")]
+!rest : pressure(Pressure) & Pressure > 80 <- stopMotor; alarm; !!rest.
+!rest <- stopMotor; !!rest.

@air_at_start[req("PUMP-3"), req("PUMP-4")]
+!start : air(Air) & Air > 50 <- stopMotor; alarm.
@blocked_at_start[req("PUMP-2")]
+!start : pressure(Pressure) & Pressure > 80 <- stopMotor; alarm.
+!start <- runMotor; !infuse.

// A danger ends the infusion: it must be started anew.
@air[req("PUMP-3"), req("PUMP-4")]
+!infuse : air(Air) & Air > 50 <- stopMotor; alarm.
@blocked[req("PUMP-2")]
+!infuse : pressure(Pressure) & Pressure > 80 <- stopMotor; alarm.
+!infuse <- runMotor; !infuse.

// ---- Silence for four steps.
+!silence <- stopMotor; showMuted; !muted(3).

+!muted(Left) : Left > 0 <- stopMotor; showMuted; !muted(Left - 1).
+!muted(_) <- stopMotor.

+!stop <- stopMotor; !!rest.
