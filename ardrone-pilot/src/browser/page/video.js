"use strict";
// Shows the pictures of the drone's camera from /video. The browser decodes them as the drone encoded them.

(() => {
  const canvas = document.getElementById("picture");
  const context = canvas.getContext("2d");
  const note = document.getElementById("novideo");
  const shoot = document.getElementById("shoot");
  // Before the picture in each message: time stamp and whether a decoder can begin with it.
  const HEAD = 5;
  // Pictures that may wait in the decoder: more of them would show the past.
  const QUEUE = 4;
  // Without a picture for this long the last one is marked as old, in milliseconds.
  const OLD = 1000;

  let decoder = null;
  let begun = false; // the decoder has got a picture with which it can begin
  let codec = "";
  let size = { width: 640, height: 360 };
  let drawnAt = 0;
  let shown = null; // the status that the overlay shows
  // For tests and the curious.
  const state = { drawn: 0, errors: 0, skipped: 0, stamp: 0, latency: [] };
  window.video = state;

  const say = (text) => {
    note.textContent = text;
    note.hidden = !text;
  };

  if (!("VideoDecoder" in window)) {
    const why = window.isSecureContext
      ? "this browser cannot decode pictures (WebCodecs); Chromium can"
      : "browsers show video only on pages that are safe: open this page on the machine that flies, as http://127.0.0.1, or tunnel it there (ssh -L 8080:127.0.0.1:8080)";
    say(`no video: ${why}`);
    return;
  }

  // "avc1.42801e": profile, constraints and level from the sequence parameter set behind the start code.
  const codecOf = (bytes) =>
    "avc1." + [5, 6, 7].map((index) => bytes[index].toString(16).padStart(2, "0")).join("");

  function draw(frame) {
    const { displayWidth: width, displayHeight: height } = frame;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    context.drawImage(frame, 0, 0);
    state.stamp = frame.timestamp / 1000;
    frame.close();
    state.drawn += 1;
    drawnAt = performance.now();
    shoot.disabled = false;
    say("");
  }

  function reset() {
    if (decoder && decoder.state !== "closed") decoder.close();
    decoder = null;
    begun = false;
  }

  function decode(message) {
    if (message.byteLength <= HEAD) {
      reset();
      say("the video stream is lost; trying again");
      return;
    }
    const entry = new DataView(message).getUint8(4) === 1;
    const bytes = new Uint8Array(message, HEAD);
    if (!begun && !entry) return;
    // A decoder that is behind continues with the newest picture that needs none before it.
    if (decoder && decoder.decodeQueueSize > QUEUE) {
      state.skipped += 1;
      reset();
      if (!entry) return;
    }
    if (entry && codecOf(bytes) !== codec) {
      reset();
      codec = codecOf(bytes);
    }
    if (!decoder) {
      decoder = new VideoDecoder({
        output: draw,
        error: (error) => {
          state.errors += 1;
          reset();
          say(`the picture cannot be decoded: ${error.message}`);
        },
      });
      decoder.configure({ codec, optimizeForLatency: true });
    }
    begun = true;
    const timestamp = new DataView(message).getUint32(0, true) * 1000;
    decoder.decode(new EncodedVideoChunk({ type: entry ? "key" : "delta", timestamp, data: bytes }));
  }

  function connect() {
    const address = new URL("video" + location.search, location.href);
    address.protocol = "ws:";
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event) => decode(event.data);
    socket.onclose = () => {
      reset();
      setTimeout(connect, over ? 3000 : 1000);
    };
  }

  // What the pilot believes, over what the camera sees.
  function drawOverlay() {
    requestAnimationFrame(drawOverlay);
    const old = drawnAt && performance.now() - drawnAt > OLD;
    canvas.classList.toggle("old", Boolean(old));
    if (old && note.hidden) say("no new picture");
    if (!status || status === shown) return;
    shown = status;
    for (const camera of ["front", "bottom"]) document.getElementById(camera).ariaPressed = String(camera === status.camera);
    if (!status.pose) return;
    const [roll, pitch] = status.attitude_deg || [0, 0];
    // The front camera sees 92 degrees along the diagonal of 734 pixels.
    const PIXELS_PER_DEGREE = 8;
    const horizon = document.getElementById("sky");
    // There is none below.
    horizon.style.display = status.camera === "bottom" ? "none" : "";
    horizon
      .setAttribute("transform", `translate(320 180) rotate(${-roll}) translate(0 ${PIXELS_PER_DEGREE * pitch})`);
    const target = status.target ? `, target ${signed(status.target.z_m)} m, ${status.distance_m.toFixed(1)} m to go` : "";
    document.getElementById("seen").textContent =
      `height ${signed(status.pose.z_m)} m, heading ${signed(status.pose.yaw_deg, 0)}\u00b0${target}`;
  }

  for (const camera of ["front", "bottom"]) {
    document.getElementById(camera).onclick = () => order({ order: "camera", camera });
  }

  shoot.onclick = () => {
    canvas.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `ardrone-${new Date().toISOString().replace(/[:.]/g, "-")}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }, "image/png");
  };

  connect();
  drawOverlay();
})();
