!watch.

@left_is_out[req("KEE-2")]
+!watch : leftInside & through[source(left)] <- keep; -leftInside; !!watch.

@right_is_out[req("KEE-2")]
+!watch : rightInside & through[source(right)] <- keep; -rightInside; !!watch.

// It waits still: what let it in was lost.
@lets_left_in_again[req("KEE-2")]
+!watch : leftInside & waiting[source(left)] & saidAt(T) & now - T > 500
  <- keep; +saidAt(now); .send(left, achieve, enter); !!watch.

@lets_right_in_again[req("KEE-2")]
+!watch : rightInside & waiting[source(right)] & saidAt(T) & now - T > 500
  <- keep; +saidAt(now); .send(right, achieve, enter); !!watch.

@is_taken[req("KEE-2")]
+!watch : leftInside | rightInside <- keep; !!watch.

@lets_left_in[req("KEE-2")]
+!watch : waiting[source(left)] & not through[source(left)]
  <- keep; +leftInside; +saidAt(now); .send(left, achieve, enter); !!watch.

@lets_right_in[req("KEE-2")]
+!watch : waiting[source(right)] & not through[source(right)]
  <- keep; +rightInside; +saidAt(now); .send(right, achieve, enter); !!watch.

@all_through
+!watch : through[source(left)] & through[source(right)] <- finish; !!watch.

+!watch <- keep; !!watch.
