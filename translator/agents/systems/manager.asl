!manage.

// The cheaper bid gets the task, once both are there.
@awards[req("CON-2")]
+!manage : open & bid(A)[source(near)] & bid(B)[source(far)] & A <= B
  <- -open; .send(near, achieve, work); .broadcast(untell, task); !!manage.
+!manage : open & bid(_)[source(near)] & bid(_)[source(far)]
  <- -open; .send(far, achieve, work); .broadcast(untell, task); !!manage.

// One task after the other is announced.
@announces[req("CON-1")]
+!manage : hasTask & not open & not busy
  <- +open; +busy; .broadcast(tell, task(nextPlace)); !!manage.

+!manage <- !!manage.

+!done <- -busy; report.
