// The autopilot: what the drone does, and when.
//
// It runs once every 30 ms. Each run takes one event, finds the first plan for it whose context
// holds, and carries the plan out to its end. Every plan issues exactly one AT command, so the
// drone hears from us in every step.
//
// The environment tells where the drone is, or while it stays or comes down, where that is to be
// (`position`), how it is (`battery`, `blindFor`, `doubt`, `saturatedFor`, `wind`), for how long it has been doing
// the same (`takingOffFor`, `approachingFor`, `searchingFor`, `overTagFor`, `stayingFor`, `descendingFor`), how long
// ago a tag on the floor was seen (`tagAge`), how far it is to the fence (`fenceRoom`), how orders are to be
// flown (`reachDistance`, `stayDistance`, `stayTime`), and whether whoever flies it is still
// there (`setpointAge`, `stationSilentFor`); it orders `takeOff`, `goTo`,
// `findTag`, `landOnTag`, `newMission`, `hold`, `steer`, `follow` and `land`. The last five pre-empt whatever runs,
// but nothing ends a landing.

// ---- Limits. Change them with care.

// Charge at which the pilot is warned, and at which the drone lands. Percent.
warningBattery(20).
landingBattery(12).
// Without believable navdata the drone holds still after this, and lands after that. Milliseconds.
holdWhenBlind(300).
landWhenBlind(2000).
// A place that is known no better than this is no place to fly by. Metres.
largestDoubt(3.0).
// The sticks are at their end and the drone is carried off all the same: it cannot hold against
// this wind. Milliseconds.
landWhenSaturated(2000).
// The drone's own landing drifts with the wind. Where it blows more than the first of these, but less
// than the second (shares of what full tilt gives), we first come down by ourselves to this height,
// in metres, but not for longer than this, in milliseconds. Where we cannot hold against it either,
// every second in the air counts.
landingWind(0.1, 0.8).
landingHeight(0.35).
comingDownTime(8000).
// A take-off that takes longer than this has failed; a target that is not reached in this time is
// given up. Milliseconds.
takeOffTime(10000).
approachTime(60000).
// A place that is known worse than this, in metres, is a reason to look for a tag; it is looked for from
// this height, in metres, for no longer than this, in milliseconds, and not with this charge or less, in
// percent.
searchDoubt(1.0).
searchHeight(2.5).
searchTime(30000).
searchBattery(20).
// Whoever found none goes on with what was ordered for this long before it looks again. Milliseconds.
searchAgain(60000).
// Above the tag to land on the drone settles at this height, until it is this near, in metres, and steady, for
// no longer than this, in milliseconds; it descends by itself to the next height, until it is steady there, for no
// longer than the last: so low the tag is not seen.
overTagHeight(0.8).
overTagReach(0.08).
overTagTime(20000).
touchDownHeight(0.3).
ontoTagTime(4000).
// A tag that was not seen for this long, in milliseconds, is lost, unless the drone is lower than this, in
// metres: there it is not whole in the picture.
tagPatience(2000).
tagLowest(0.6).

// Setpoints that stop coming: the drone holds after this, and lands after that. Milliseconds.
holdWithoutSetpoints(500).
landWithoutSetpoints(10500).
// The ground station that has the controls is silent: that is told after this. Milliseconds. When the drone holds, and when it
// lands, is settled before the flight.
tellWithoutStation(3000).
holdWithoutStation(10000).
landWithoutStation(20000).

// Nothing has lasted yet, and nothing is known of where it could be.
saturatedFor(0).
takingOffFor(0).
approachingFor(0).
searchingFor(0).
overTagFor(0).
stayingFor(0).
tagAge(0).
searchAgo(1000000000).
fenceRoom(0.0).
searchFrom(0.0, 0.0, 0.0).
descendingFor(0).
setpointAge(0).
stationSilentFor(0).
wind(0.0).

// How orders are flown until they say so themselves.
reachDistance(0.2).
stayDistance(0.5).
stayTime(2000).

!wait.

// ---- Watching over the flight. Every plan that keeps the drone in the air asks this first. Where
// that is no longer safe, the reason is told and the plan fails: its failure plan goes down, in the
// same step.

@empty_battery[req("SAF-4")]
+!watch : battery(Percent) & landingBattery(Limit) & Percent <= Limit
  <- tellBatteryEmpty;
     ?airworthy.

@blind[req("SAF-5")]
+!watch : blindFor(Time) & landWhenBlind(Limit) & Time > Limit
  <- tellBlind;
     ?airworthy.

// A doubt that is no number is no small one.
@lost[req("SAF-5")]
+!watch : doubt(Metres) & largestDoubt(Limit) & not Metres <= Limit
  <- tellLost;
     ?airworthy.

@too_weak[req("SAF-5")]
+!watch : saturatedFor(Time) & landWhenSaturated(Limit) & Time > Limit
  <- tellWind;
     ?airworthy.

@not_up_in_time[req("SAF-7")]
+!watch : takingOffFor(Time) & takeOffTime(Limit) & Time > Limit
  <- tellNoProgress;
     ?airworthy.

@not_there_in_time[req("SAF-7")]
+!watch : approachingFor(Time) & approachTime(Limit) & Time > Limit
  <- tellNoProgress;
     ?airworthy.

@setpoints_gone[req("SAF-9")]
+!watch : setpointAge(Time) & landWithoutSetpoints(Limit) & Time > Limit
  <- tellSetpointsGone;
     ?airworthy.

@station_gone[req("SAF-9")]
+!watch : stationSilentFor(Time) & landWithoutStation(Limit) & Time > Limit
  <- tellStationGone;
     ?airworthy.

@low_battery[req("SAF-4")]
+!watch : battery(Percent) & warningBattery(Limit) & Percent <= Limit & not batteryWarned
  <- +batteryWarned;
     tellBatteryLow.

@station_silent[req("SAF-9")]
+!watch : stationSilentFor(Time) & tellWithoutStation(Limit) & Time > Limit
  <- tellStationSilent.

+!watch.

// ---- Holding still where the drone is.

+!holdHere : position(X, Y, Z, Yaw)
  <- +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw).

+!holdHere
  <- -target(_, _, _, _);
     sendHover.

// ---- Waiting for an order: stay where we are.

+!wait : onGround
  <- sendStandby;
     !!wait.

+!wait : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !!wait.

+!wait : target(X, Y, Z, Yaw)
  <- !watch;
     sendStay(X, Y, Z, Yaw);
     !!wait.

+!wait
  <- !watch;
     sendHover;
     !!wait.

@danger_waiting[req("SAF-4"), req("SAF-5")]
-!wait <- !goDown; !comeDown.

// ---- Taking off. The drone climbs by itself; it is done when it says that it hovers.
// The place where it then is becomes the target to hold.

@take_off[req("SAF-3")]
+!takeOff : onGround & position(_, _, _, _) & blindFor(Time) & holdWhenBlind(Limit) & Time <= Limit
  <- !watch;
     -target(_, _, _, _);
     -comingDown;
     sendTakeOff;
     !completeTakeOff.

// Whose place is not known, or was long ago, stays on the ground.
@no_trust_to_take_off[req("SAF-3")]
+!takeOff : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

// In the air already: take over where the drone is.
+!takeOff : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     reportDone;
     !!wait.

// In the air and no idea where: hold still.
+!takeOff
  <- !watch;
     sendHover;
     reportFailed;
     !!wait.

@danger_before_take_off[req("SAF-4"), req("SAF-5")]
-!takeOff : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

@danger_taking_over[req("SAF-4"), req("SAF-5")]
-!takeOff <- !goDown; !comeDown.

+!completeTakeOff : hovering & position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     reportDone;
     !!wait.

@still_taking_off[req("SAF-3")]
+!completeTakeOff
  <- !watch;
     sendTakeOffAgain;
     !completeTakeOff.

@danger_taking_off[req("SAF-4"), req("SAF-5"), req("SAF-7")]
-!completeTakeOff <- !goDown; !comeDown.

// ---- Going somewhere: approach until close enough, then stay a while.

+!goTo(_, _, _, _) : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

// Nobody may be there any more who ordered it: it waits until it is ordered again.
@nobody_sends[req("SAF-9")]
+!goTo(_, _, _, _) : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

+!goTo(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendGoto(X, Y, Z, Yaw);
     !approach.

@danger_setting_out[req("SAF-4"), req("SAF-5")]
-!goTo(_, _, _, _) <- !goDown; !comeDown.

+!approach : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

+!approach : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !approach.

@nobody_waits[req("SAF-9")]
+!approach : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

// The place has become doubtful: look for a tag, then go on.
@look_for_the_place
+!approach : doubt(Metres) & searchDoubt(Limit) & Metres > Limit & tagsInUse & not tagSeen
    & searchAgo(Time) & searchAgain(Pause) & Time > Pause & position(_, _, _, _)
  <- !watch;
     tellSearching;
     !lookAround;
     !search(1).

+!approach : target(X, Y, Z, Yaw) & reachDistance(Distance) & closeEnough(X, Y, Z, Yaw, Distance)
  <- !watch;
     sendStay(X, Y, Z, Yaw);
     !stay.

+!approach : target(X, Y, Z, Yaw)
  <- !watch;
     sendGotoAgain(X, Y, Z, Yaw);
     !approach.

@danger_approaching[req("SAF-4"), req("SAF-5"), req("SAF-7")]
-!approach <- !goDown; !comeDown.

+!stay : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

+!stay : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !stay.

@nobody_waits_here[req("SAF-9")]
+!stay : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

// The place has become doubtful: look for a tag, as when approaching.
@look_for_the_place_held
+!stay : doubt(Metres) & searchDoubt(Limit) & Metres > Limit & tagsInUse & not tagSeen
    & searchAgo(Time) & searchAgain(Pause) & Time > Pause & position(_, _, _, _)
  <- !watch;
     tellSearching;
     !lookAround;
     !search(1).

// Drifted off: approach again, and the stay begins anew. However long it was, only the time of
// approaching counts against its limit.
+!stay : target(X, Y, Z, Yaw) & stayDistance(Distance) & not closeEnough(X, Y, Z, Yaw, Distance)
  <- !watch;
     sendGotoAgain(X, Y, Z, Yaw);
     !approach.

+!stay : target(X, Y, Z, Yaw) & stayingFor(Time) & stayTime(Enough) & Time > Enough
  <- !watch;
     sendStay(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!stay : target(X, Y, Z, Yaw)
  <- !watch;
     sendStay(X, Y, Z, Yaw);
     !stay.

@danger_staying[req("SAF-4"), req("SAF-5")]
-!stay <- !goDown; !comeDown.

// ---- Looking for a tag: climb where one should be, or here, then look down from places around. Whoever looks says
// what for: 0 a tag was ordered to be found, 1 to go on approaching, 2 to land on it.

+!findTag : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

+!findTag : tagSeen & position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     reportDone;
     !!wait.

@nobody_looks[req("SAF-9")]
+!findTag : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

+!findTag : tagsInUse & position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     !lookAround;
     !search(0).

// Tags are not in use, or nobody knows where the drone is.
+!findTag
  <- !watch;
     tellNoTag;
     sendHover;
     reportFailed;
     !!wait.

@danger_setting_out_to_search[req("SAF-4"), req("SAF-5")]
-!findTag <- !goDown; !comeDown.

// The first command of a search, if there may be one.
+!lookAround : searchingFor(Time) & searchTime(Limit) & Time > Limit
    | battery(Percent) & searchBattery(Least) & Percent <= Least
    | fenceRoom(Room) & not Room >= 0.0
  <- sendHover.

+!lookAround : position(_, _, _, Yaw) & tagKnown & searchHeight(Z) & X = tagX & Y = tagY
  <- +searchFrom(X, Y, Yaw);
     sendSearch(X, Y, Z, Yaw).

+!lookAround : position(X, Y, _, Yaw) & searchHeight(Z)
  <- +searchFrom(X, Y, Yaw);
     sendSearch(X, Y, Z, Yaw).

+!lookAround
  <- sendHover.

+!search(_) : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

+!search(Then) : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !search(Then).

@nobody_searches[req("SAF-9")]
+!search(_) : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

+!search(0) : tagSeen & position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     reportDone;
     !!wait.

+!search(1) : tagSeen & target(X, Y, Z, Yaw)
  <- !watch;
     sendGotoAgain(X, Y, Z, Yaw);
     !approach.

+!search(2) : tagSeen & tagKnown & position(_, _, _, Yaw) & overTagHeight(Z) & X = tagX & Y = tagY
    & overTagFor(Time) & overTagTime(Most) & Time <= Most
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendOverTag(X, Y, Z, Yaw);
     !overTag.

@search_ends[req("SAF-4"), req("SAF-7")]
+!search(Then) : searchingFor(Time) & searchTime(Limit) & Time > Limit
    | battery(Percent) & searchBattery(Least) & Percent <= Least
    | fenceRoom(Room) & not Room >= 0.0
  <- !watch;
     tellNoTag;
     sendHover;
     !noTag(Then).

+!search(Then) : searchFrom(X, Y, Yaw) & searchHeight(Z) & searchingFor(Time)
  <- !watch;
     ?searchOffset(Time, Right, Forward);
     sendSearch(X + Right, Y + Forward, Z, Yaw);
     !search(Then).

+!search(Then)
  <- !watch;
     tellNoTag;
     sendHover;
     !noTag(Then).

@danger_searching[req("SAF-4"), req("SAF-5")]
-!search(_) <- !goDown; !comeDown.

// Where to look after so much time, right and forward of where the search began: 3 s for each place,
// half of them to look.
+?searchOffset(Time, Right, Forward) : Time < 5000 <- Right = 0.0; Forward = 0.0.
+?searchOffset(Time, Right, Forward) : Time < 8000 <- Right = 0.0; Forward = 1.4.
+?searchOffset(Time, Right, Forward) : Time < 11000 <- Right = 1.4; Forward = 1.4.
+?searchOffset(Time, Right, Forward) : Time < 14000 <- Right = 1.4; Forward = 0.0.
+?searchOffset(Time, Right, Forward) : Time < 17000 <- Right = 1.4; Forward = -1.4.
+?searchOffset(Time, Right, Forward) : Time < 20000 <- Right = 0.0; Forward = -1.4.
+?searchOffset(Time, Right, Forward) : Time < 23000 <- Right = -1.4; Forward = -1.4.
+?searchOffset(Time, Right, Forward) : Time < 26000 <- Right = -1.4; Forward = 0.0.
+?searchOffset(_, Right, Forward) <- Right = -1.4; Forward = 1.4.

// None was found.
+!noTag(0) : not onGround
  <- !watch;
     sendHover;
     reportFailed;
     !!wait.

@somebody_goes_on[req("SAF-9")]
+!noTag(1) : not onGround & target(X, Y, Z, Yaw)
    & stationSilentFor(Time) & holdWithoutStation(Limit) & Time <= Limit
  <- !watch;
     sendGotoAgain(X, Y, Z, Yaw);
     !approach.

// Whoever was to land on it lands here, and so does the drone for which nobody is there any more.
+!noTag(_)
  <- reportFailed;
     !goDown;
     !comeDown.

@danger_without_tag[req("SAF-4"), req("SAF-5")]
-!noTag(_) <- !goDown; !comeDown.

// ---- Landing on a tag: settle above it, then descend by ourselves as long as it is seen, then by the drone.
// Whatever goes wrong, the drone lands where it is.

+!landOnTag : onGround
  <- reportRefused;
     sendStandby;
     !!wait.

+!landOnTag : tagSeen & tagKnown & position(_, _, _, Yaw) & overTagHeight(Z) & X = tagX & Y = tagY
    & overTagFor(Time) & overTagTime(Most) & Time <= Most
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendOverTag(X, Y, Z, Yaw);
     !overTag.

@nobody_lands_it[req("SAF-9")]
+!landOnTag : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

+!landOnTag : tagsInUse & position(_, _, _, _)
  <- !watch;
     !lookAround;
     !search(2).

+!landOnTag
  <- tellNoTag;
     reportFailed;
     !goDown;
     !comeDown.

@danger_before_landing_on_tag[req("SAF-4"), req("SAF-5")]
-!landOnTag <- !goDown; !comeDown.

+!overTag : onGround
  <- sendStandby;
     reportFailed;
     !!wait.

@tag_lost_above_it[req("SAF-2")]
+!overTag : not tagKnown | tagAge(Time) & tagPatience(Limit) & Time > Limit
  <- tellTagLost;
     reportFailed;
     !goDown;
     !comeDown.

@blind_above_tag[req("SAF-2")]
+!overTag : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit & overTagFor(Above) & overTagTime(Most)
    & Above <= Most
  <- !watch;
     sendTagPause;
     !overTag.

// The place of the tag is known better by now.
@above_the_tag_anew[req("SAF-2"), req("SAF-7")]
+!overTag : target(OldX, OldY, Z, Yaw) & not nearTag(OldX, OldY) & X = tagX & Y = tagY
    & overTagFor(Time) & overTagTime(Most) & Time <= Most
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendOverTagAgain(X, Y, Z, Yaw);
     !overTag.

@settling_above_tag[req("SAF-2"), req("SAF-7")]
+!overTag : target(X, Y, Z, Yaw) & overTagFor(Time) & overTagTime(Most) & Time <= Most
    & overTagReach(Near) & (not closeEnough(X, Y, Z, Yaw, Near) | not steady)
  <- !watch;
     sendOverTagAgain(X, Y, Z, Yaw);
     !overTag.

// Settled, or long enough: down, to a place that stays what it is: a target that moves a little in every step
// keeps the drone from settling.
@down_onto_tag[req("SAF-2"), req("SAF-7")]
+!overTag : target(_, _, _, Yaw) & touchDownHeight(Z)
    & descendingFor(Time) & comingDownTime(Limit) & Time <= Limit & X = landingX & Y = landingY
  <- +comingDown;
     +target(X, Y, Z, Yaw);
     sendDescent(X, Y, Z, Yaw);
     !ontoTag.

+!overTag <- !goDown; !comeDown.

@danger_above_tag[req("SAF-4"), req("SAF-5")]
-!overTag <- !goDown; !comeDown.

@landed_on_tag[req("SAF-2")]
+!ontoTag : onGround
  <- -comingDown;
     sendStandby;
     reportDone;
     !!wait.

@too_long_onto_tag[req("SAF-2"), req("SAF-7")]
+!ontoTag : descendingFor(Time) & comingDownTime(Limit) & Time > Limit
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

@tag_gone_descending[req("SAF-2")]
+!ontoTag : not tagKnown
  <- -target(_, _, _, _);
     tellTagLost;
     reportFailed;
     sendLand;
     !comeDown.

@tag_lost_descending[req("SAF-2")]
+!ontoTag : tagAge(Time) & tagPatience(Limit) & Time > Limit & position(_, _, Height, _) & tagLowest(Low)
    & Height > Low
  <- -target(_, _, _, _);
     tellTagLost;
     reportFailed;
     sendLand;
     !comeDown.

@blind_onto_tag[req("SAF-2")]
+!ontoTag : blindFor(Time) & holdWhenBlind(Patience) & Time > Patience
  <- !watch;
     sendPause;
     !ontoTag.

@descend_onto_tag[req("SAF-2")]
+!ontoTag : target(X, Y, Z, Yaw) & position(_, _, Height, _)
    & (Height > Z + 0.02 | not steady) & descendingFor(Time) & ontoTagTime(Most) & Time <= Most
  <- sendDescent(X, Y, Z, Yaw);
     !ontoTag.

@by_itself_onto_tag[req("SAF-2")]
+!ontoTag
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

@danger_onto_tag[req("SAF-4"), req("SAF-5")]
-!ontoTag
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

// ---- A mission was loaded, replaced or cleared. What was ordered for the one before is given up:
// hold where we are until an order of the new one comes. A landing goes on, by the drone itself.

+!newMission : onGround
  <- -comingDown;
     sendStandby;
     !!wait.

@new_mission_while_landing[req("SAF-2")]
+!newMission : comingDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

+!newMission : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     !!wait.

+!newMission
  <- !watch;
     -target(_, _, _, _);
     sendHover;
     !!wait.

@danger_between_missions[req("SAF-4"), req("SAF-5")]
-!newMission <- !goDown; !comeDown.

// ---- Manual control. Hold where we are, until told otherwise. In danger it does not keep the
// drone in the air either.

+!hold : onGround
  <- -comingDown;
     sendStandby;
     !!wait.

@hold_while_landing[req("SAF-2")]
+!hold : comingDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

+!hold : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     !!wait.

+!hold
  <- !watch;
     -target(_, _, _, _);
     sendHover;
     !!wait.

@danger_holding[req("SAF-4"), req("SAF-5")]
-!hold <- !goDown; !comeDown.

// As the sticks say, as long as they are moved.
+!steer : onGround
  <- -comingDown;
     sendStandby;
     !!wait.

@steer_while_landing[req("SAF-2")]
+!steer : comingDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

+!steer : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendHover;
     !!wait.

@nobody_steers[req("SAF-9")]
+!steer : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit
  <- !watch;
     !holdHere;
     !!wait.

+!steer : steering
  <- !watch;
     sendSticks;
     !steer.

+!steer : position(X, Y, Z, Yaw)
  <- !watch;
     +target(X, Y, Z, Yaw);
     sendStay(X, Y, Z, Yaw);
     !!wait.

+!steer
  <- !watch;
     sendHover;
     !!wait.

@danger_steering[req("SAF-4"), req("SAF-5")]
-!steer <- !goDown; !comeDown.

// To where an operator's setpoints say, as long as they keep coming. Where they have stopped, only another order begins anew.

+!follow : onGround
  <- -comingDown;
     sendStandby;
     !!wait.

@follow_while_landing[req("SAF-2")]
+!follow : comingDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

@setpoints_silent[req("SAF-9")]
+!follow : setpointAge(Time) & holdWithoutSetpoints(Limit) & Time > Limit
    | stationSilentFor(Silent) & holdWithoutStation(Longest) & Silent > Longest
  <- !watch;
     !holdHere;
     reportPaused;
     !!wait.

+!follow : blindFor(Time) & holdWhenBlind(Limit) & Time > Limit
  <- !watch;
     sendSetpointPause;
     !follow.

+!follow
  <- !watch;
     sendSetpoint;
     !follow.

@danger_following[req("SAF-4"), req("SAF-5"), req("SAF-9")]
-!follow <- !goDown; !comeDown.

// ---- Landing: where it blows by ourselves as far as we can, with eyes open; then by the drone.
// While we come down by ourselves there is a target; the drone's own landing has none.

@landed_already[req("SAF-2")]
+!land : onGround
  <- sendStandby;
     reportDone;
     !!wait.

@land[req("SAF-2")]
+!land <- !goDown; !comeDown.

// The first command of each way down.
@go_down_in_wind[req("SAF-2")]
+!goDown : wind(Share) & landingWind(Breeze, Storm) & Share > Breeze & Share < Storm
    & saturatedFor(Weak) & landWhenSaturated(Most) & Weak <= Most
    & blindFor(Blind) & holdWhenBlind(Patience) & Blind <= Patience
    & descendingFor(Time) & comingDownTime(Limit) & Time <= Limit
    & position(X, Y, Z, Yaw) & landingHeight(Low) & Z > Low
  <- +comingDown;
     +target(X, Y, Low, Yaw);
     sendDescent(X, Y, Low, Yaw).

@go_down[req("SAF-2")]
+!goDown
  <- +comingDown;
     -target(_, _, _, _);
     sendLand.

@landed[req("SAF-2")]
+!comeDown : onGround
  <- -comingDown;
     sendStandby;
     reportDone;
     !!wait.

@too_long_descending[req("SAF-2"), req("SAF-7")]
+!comeDown : descendingFor(Time) & comingDownTime(Limit) & Time > Limit
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

// Blind for a moment, and nothing else is wrong: wait for it to pass.
@blind_descending[req("SAF-2")]
+!comeDown : target(_, _, _, _) & blindFor(Time) & holdWhenBlind(Patience) & Time > Patience
  <- !watch;
     sendPause;
     !comeDown.

@descend[req("SAF-2")]
+!comeDown : target(X, Y, Z, Yaw) & position(_, _, Height, _) & Height > Z + 0.1
  <- sendDescent(X, Y, Z, Yaw);
     !comeDown.

// The order is repeated until the drone says that it has landed.
@still_landing[req("SAF-2")]
+!comeDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.

@danger_descending[req("SAF-4"), req("SAF-5")]
-!comeDown
  <- -target(_, _, _, _);
     sendLand;
     !comeDown.
