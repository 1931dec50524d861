"use strict";
// What an operator must see at once and hear: the worst danger in words of what to do, and short tones.

const dangers = (() => {
  // Without a message for this long the page shows an alarm, in milliseconds.
  const SILENCE = 1000;
  // A warning is shown for this long, in milliseconds.
  const SHOWN = 8000;
  // Navdata of this age are missing, in seconds; older ones than the second are a lost link.
  const [LATE_S, LOST_S] = [0.5, 2];
  // Position uncertainty from which the position is doubtful, in metres.
  const DOUBTFUL_M = 1;
  const MUTED = "ardrone-pilot muted";

  let warned = { text: "", at: -Infinity }; // the last event that warns
  let sounded = ""; // the danger for which a tone was heard
  let audio = null;
  const heardTones = []; // for tests and the curious: the level of each tone
  let muted = false;
  try {
    muted = localStorage.getItem(MUTED) === "yes";
  } catch {
    // Without storage it begins with sound.
  }

  // The worst danger: { level: "alarm" or "warn" or "over", text }, or null.
  function worst() {
    const now = performance.now();
    const seconds = (time) => `${(time / 1000).toFixed(0)} s`;
    if (over) return { level: status && status.emergency ? "alarm" : "over", text: over };
    const silence = now - heard;
    if (silence > SILENCE) {
      const since = heard ? ` for ${seconds(silence)}` : "";
      return { level: "alarm", text: `No data from ardrone-pilot${since}: what is shown is old. Orders of this page do not arrive; use the terminal.` };
    }
    if (behind > SILENCE) return { level: "alarm", text: `This page is ${seconds(behind)} behind: the connection is slow.` };
    if (!status || !flight) return null;
    if (status.emergency) {
      return { level: "alarm", text: "EMERGENCY: the motors are off. Keep away until it lies still. Whole and upright? Recover, then start." };
    }
    const flies = isAirborne();
    const age = status.navdata_age_s;
    if (flies && age > LOST_S) return { level: "alarm", text: `LINK LOST for ${age.toFixed(0)} s: the drone is ordered to land. Go nearer with this machine, and keep people away.` };
    if (status.landing && !status.landing_ordered) return { level: "alarm", text: `LANDING: ${status.landing}. Keep the ground below it free.` };
    if (flies && status.battery_percent !== null && status.battery_percent <= flight.battery_lands_percent) return { level: "alarm", text: `BATTERY at ${status.battery_percent} %: land now.` };
    if (flies && status.contradicted_by) return { level: "alarm", text: `THE PLACE IS WRONG: ${status.contradicted_by} contradicts it. Watch the drone itself; land, or fly it by hand.` };
    if (flies && age > LATE_S) return { level: "warn", text: `No navdata for ${age.toFixed(1)} s: the drone hovers until they come.` };
    if (flies && status.battery_percent !== null && status.battery_percent <= flight.battery_warns_percent) return { level: "warn", text: `Battery at ${status.battery_percent} %: land soon.` };
    if (flies && status.uncertainty_m > DOUBTFUL_M) return { level: "warn", text: `The uncertainty of the place is ${status.uncertainty_m.toFixed(1)} m: watch the drone itself.` };
    if (now - warned.at < SHOWN) return { level: "warn", text: warned.text };
    return null;
  }

  // A short tone: one for a warning, three for an alarm.
  function sound(level) {
    if (muted) return;
    heardTones.push(level);
    if (heardTones.length > 100) heardTones.shift();
    try {
      audio ??= new AudioContext();
      // Browsers play nothing before the first click or key.
      if (audio.state === "suspended") audio.resume();
      const [count, pitch] = level === "alarm" ? [3, 988] : [1, 659];
      for (let tone = 0; tone < count; tone += 1) {
        const from = audio.currentTime + tone * 0.22;
        const [source, volume] = [audio.createOscillator(), audio.createGain()];
        source.frequency.value = pitch;
        volume.gain.setValueAtTime(0.2, from);
        volume.gain.exponentialRampToValueAtTime(0.001, from + 0.16);
        source.connect(volume).connect(audio.destination);
        source.start(from);
        source.stop(from + 0.18);
      }
    } catch {
      // A machine without sound shows it all the same.
    }
  }

  function draw() {
    // What was warned of before is over when the emergency is.
    if (status?.emergency) warned.at = -Infinity;
    const danger = worst();
    const alarm = $("alarm");
    alarm.hidden = !danger;
    // Said again only if it changes: it is read aloud.
    if (danger && alarm.textContent !== danger.text) alarm.textContent = danger.text;
    $("bar").className = danger ? danger.level : "";
    // Together with what is said of it.
    document.body.classList.toggle("stale", Boolean(over) || !socket || socket.readyState !== WebSocket.OPEN);
    $("doing").style.visibility = danger ? "hidden" : "";
    // Counting seconds are no new danger.
    const kind = danger ? danger.level + danger.text.replace(/[\d.]+/g, "") : "";
    if (kind !== sounded && danger && danger.level !== "over") sound(danger.level);
    sounded = kind;
  }

  function drawMute() {
    $("mute").ariaPressed = String(muted);
    $("mute").textContent = muted ? "Sound off" : "Sound on";
  }
  $("mute").onclick = () => {
    muted = !muted;
    try {
      localStorage.setItem(MUTED, muted ? "yes" : "no");
    } catch {
      // It is forgotten with the page.
    }
    drawMute();
  };
  drawMute();

  return {
    draw,
    // An event that warns has come now.
    warn: (text) => (warned = { text: text[0].toUpperCase() + text.slice(1), at: performance.now() }),
    isCalm: () => !worst() || worst().level === "warn",
    heard: () => heardTones,
  };
})();
