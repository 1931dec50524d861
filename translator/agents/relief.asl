!wait.

// It is low, and the other one watches: it goes, and says so.
@relieved[req("REL-2")]
+!wait : low[source(self)] & watching[source(self)] & watching[source(P)] & P \== self & not low[source(P)]
  <- goHome; -watching; .broadcast(untell, watching); !!wait.

+!wait : low[source(self)] & not watching[source(self)] <- goHome; !!wait.

// It is low for the first time.
+!wait : charge(C) & C < 30 & not low[source(self)]
  <- hover; +low; .broadcast(tell, low); !!wait.

// It has arrived.
+!wait : isAtPlace & not watching[source(self)] & not low[source(self)]
  <- watch; +watching; .broadcast(tell, watching); !!wait.

// The other one is low and has to be relieved.
@relieves[req("REL-3")]
+!wait : low[source(P)] & P \== self & not low[source(self)] & not watching[source(self)]
  <- flyToPlace; !!wait.

+!wait : watching[source(self)] <- watch; !!wait.

+!wait <- hover; !!wait.
