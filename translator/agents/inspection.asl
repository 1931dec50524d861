// A drone that flies from pole to pole, photographs each, and comes home when it is done, recalled, or in danger.

!wait.

+!wait : charge(Left) & Left < 30 <- goHome; !!wait.
+!wait : wind(Speed) & Speed > 12.0 <- goHome; !!wait.
+!wait <- hover; !!wait.

// From one pole to another.
+!inspect(_, _) : charge(Left) & Left < 30 <- goHome; !homeward.
+!inspect(_, _) : wind(Speed) & Speed > 12.0 <- goHome; !homeward.
+!inspect(First, Last) : First <= Last <- +last(Last); hover; !approach(First).
+!inspect(_, _) <- hover.

@low[req("INSP-2")]
+!approach(_) : charge(Left) & Left < 30 <- goHome; !homeward.
@windy[req("INSP-3")]
+!approach(_) : wind(Speed) & Speed > 12.0 <- goHome; !homeward.
+!approach(Pole) : isThere(east(Pole), north(Pole)) & last(Last) & Pole < Last
  <- hover; photograph(Pole); !approach(Pole + 1).
+!approach(Pole) : isThere(east(Pole), north(Pole)) <- goHome; photograph(Pole); !homeward.
+!approach(Pole) <- flyTo(east(Pole), north(Pole)); !approach(Pole).

+!homeward : charge(Left) & Left < 30 <- goHome; !homeward.
+!homeward : wind(Speed) & Speed > 12.0 <- goHome; !homeward.
+!homeward : isHome <- hover; !!wait.
+!homeward <- goHome; !homeward.

@recall[req("INSP-4")]
+!recall <- goHome; !homeward.
