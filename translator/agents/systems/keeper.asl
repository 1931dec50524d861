!watch.

// Who waits is let in, if the corridor is free.
@lets_in[req("COR-2")]
+!watch : waiting[source(P)] & not taken <- +taken; .send(P, achieve, enter); !!watch.

+!watch <- !!watch.

+!release <- -taken.
