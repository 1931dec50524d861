// A traffic light that is green for cars until somebody on foot asks. It waits by a clock in milliseconds.

!go.

// What waits at its end with `!!` lets requests in.
+!go <- carsGreen; .wait(20000); !!ready.

@asked[req("CROSS-2")]
+!ready : requested <- carsYellow; .wait(3000); !stop.
+!ready <- !!ready.

+!stop <- carsRed; .wait(1000); !cross.
+!cross <- walk; .wait(10000); dontWalk; -requested; .wait(2000); !go.

+!request <- +requested.

// ---- A fault drops whatever runs; all blinks until somebody has repaired it.

@fault[req("CROSS-3")]
+!fault <- -requested; blink; !blinking.
+!blinking <- blink; !blinking.

+!repaired <- -requested; carsRed; dontWalk; .wait(5000); !go.
