!live.

@works[req("CON-3")]
+!live : working & isDone <- rest; -working; .send(manager, achieve, done); !!live.
+!live : working <- advance; !!live.
+!live <- rest; !!live.

// It says what the task would cost.
@bids[req("CON-1")]
+task(Place) : distanceTo(Place) < 1000 <- rest; .send(manager, tell, bid(distanceTo(Place))).
+task(_) <- rest; .send(manager, tell, bid(1000)).

-task(_) <- rest; .send(manager, untell, bid).

+!work <- rest; +working.
