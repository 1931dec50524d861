// Place 1 is home; the one that leads flies round the others.
relieveBelow(40).
homeBelow(20).
lastLeg(12).
beside(2.2, 0.0).

!fly.

@person
+!fly : not obeyed <- keep; !!fly.

// ---- Home.

@done
+!fly : homeward & onGround <- finish; !!fly.

@lands_on_tag
+!fly : homeward & flying & tagsInUse & near(placeX(1), placeY(1), placeHeight(1), 0.5) <- landOnTag; !!fly.

@lands
+!fly : homeward & flying & near(placeX(1), placeY(1), placeHeight(1), 0.5) <- land; !!fly.

@goes_home
+!fly : homeward & flying <- flyTo(placeX(1), placeY(1), placeHeight(1), placeYaw(1)); !!fly.

+!fly : homeward <- keep; !!fly.

@nearly_empty[req("WIN-2")]
+!fly : charge(C) & homeBelow(L) & C < L <- hover; +homeward; -leading; !!fly.

@relieved
+!fly : leading & isLow & leads[source(P)] & P \== self <- hover; -leading; +homeward; !!fly.

@all_legs_flown
+!fly : leading & legNow(N) & lastLeg(L) & N > L <- hover; -leading; +homeward; .broadcast(tell, leg(N)); !!fly.

@nothing_left_to_lead
+!fly : not leading & leg(N)[source(P)] & P \== self & lastLeg(L) & N > L & flying <- hover; +homeward; !!fly.

// ---- The one that leads.

@first
+!fly : .my_name(leader) & not begun <- keep; +begun; +leading; +legNow(1); !!fly.

@takes_off
+!fly : leading & onGround <- takeOff; !!fly.

@becomes_low
+!fly : leading & flying & not isLow & charge(C) & relieveBelow(L) & C < L
  <- hover; +isLow; .broadcast(tell, low); !!fly.

@reaches_a_place
+!fly : leading & flying & legNow(N)
    & near(placeX(2 + N mod (places - 1)), placeY(2 + N mod (places - 1)), placeHeight(2 + N mod (places - 1)), 0.3)
  <- +legNow(N + 1); hover; !say; !!fly.

@leads
+!fly : leading & flying & legNow(N) & Place = 2 + N mod (places - 1)
  <- flyTo(placeX(Place), placeY(Place), placeHeight(Place), placeYaw(Place)); !say; !!fly.

// ---- The one beside it.

@relieves
+!fly : low[source(P)] & P \== self & not leading & not isLow & flying & leg(N)[source(P)]
  <- hover; +leading; +legNow(N); .broadcast(tell, leads); !!fly.

@follows_up
+!fly : not begun & onGround & at(_, _, _, _)[source(P), age(A)] & P \== self & A < 1000
  <- takeOff; +begun; !!fly.

@goes_beside
+!fly : flying & at(X, Y, Z, Yaw)[source(P), age(A)] & P \== self & A < 1000 & beside(Right, Forward)
  <- follow(X + Right, Y + Forward, Z, Yaw); !!fly.

@hears_nothing
+!fly : flying <- hover; !!fly.

+!fly <- keep; !!fly.

// There are no places to fly to.
-!fly <- keep; !!fly.

// Five times a second is enough.
+!say : saidAt(T) & now - T < 200.
+!say : position(X, Y, Z, Yaw) & legNow(N)
  <- +saidAt(now); .broadcast(tell, at(X, Y, Z, Yaw)); .broadcast(tell, leg(N)).
+!say.
