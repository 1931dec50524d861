// Places: 1 where it waits, in front of the corridor; 2 the other end of the corridor; 3 where it lands.
!travel.

@person
+!travel : not obeyed <- keep; !!travel.

@done
+!travel : isThrough & onGround <- finish; !sayThrough; !!travel.

@lands
+!travel : isThrough & near(placeX(3), placeY(3), placeHeight(3), 0.5) <- land; !sayThrough; !!travel.

@goes_on
+!travel : isThrough & flying
  <- flyTo(placeX(3), placeY(3), placeHeight(3), placeYaw(3)); !sayThrough; !!travel.

// It lands. It never goes in again.
@comes_down
+!travel : isThrough <- keep; !sayThrough; !!travel.

@comes_out[req("TRA-2")]
+!travel : inside & flying & near(placeX(2), placeY(2), placeHeight(2), 0.4)
  <- hover; -inside; +isThrough; -saidAt(_); !sayThrough; !!travel.

@goes_through[req("TRA-2")]
+!travel : inside & flying <- flyThrough(placeX(2), placeY(2), placeHeight(2), placeYaw(2)); !!travel.

@waits
+!travel : wants & flying <- hover; !sayWaiting; !!travel.

@is_there
+!travel : flying & near(placeX(1), placeY(1), placeHeight(1), 0.4)
  <- hover; +wants; !sayWaiting; !!travel.

@comes
+!travel : flying <- flyTo(placeX(1), placeY(1), placeHeight(1), placeYaw(1)); !!travel.

@takes_off
+!travel : onGround <- takeOff; !!travel.

@in_between
+!travel <- keep; !!travel.

// A message may be lost: it is said again.
+!sayWaiting : saidAt(T) & now - T < 500.
+!sayWaiting <- +saidAt(now); .send(keeper, tell, waiting).

+!sayThrough : saidAt(T) & now - T < 500.
+!sayThrough <- +saidAt(now); .send(keeper, untell, waiting); .send(keeper, tell, through).

@is_let_in[req("TRA-2")]
+!enter : wants <- keep; -wants; +inside.

// It was let in once already.
+!enter <- keep.
