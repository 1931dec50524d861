!travel.

// It waits, and says so in each step: a message may be lost.
+!travel : wants <- hold; .send(keeper, tell, waiting); !!travel.
+!travel : isWanted & not inside <- hold; +wants; !!travel.
+!travel : inside & isThrough <- hold; -inside; .send(keeper, achieve, release); !!travel.
+!travel : inside <- pass; !!travel.
+!travel <- hold; !!travel.

@enters[req("COR-3")]
+!enter : wants <- hold; -wants; +inside; .send(keeper, untell, waiting).

// The keeper has heard that it waits only after it had passed: it does not enter again.
+!enter <- hold; .send(keeper, achieve, release).
