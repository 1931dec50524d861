//! Controls a headless Chromium through the `DevTools` protocol, as far as these tests need it.

use std::io::{BufRead as _, BufReader, ErrorKind};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Condvar, Mutex};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

/// Timeout of all operations of a page, even on a busy machine.
const PATIENCE: Duration = Duration::from_mins(2);
/// That the drone lands on an operator's order: the landing is over soon, and this stays.
pub(crate) const LANDS: &str =
    "document.querySelector('#events').textContent.includes(\"landing: the operator's order\")";

/// How many browsers may still be started. Each takes most of a core: with more of them pages stand still for
/// seconds, while what they show flies on.
static PLACES: Mutex<usize> = Mutex::new(2);
static PLACE_IS_FREE: Condvar = Condvar::new();

/// One of [`PLACES`], given back when dropped.
struct Place;

impl Place {
    fn take() -> Self {
        let places = PLACES.lock().unwrap();
        *PLACE_IS_FREE.wait_while(places, |places| *places == 0).unwrap() -= 1;
        Self
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        *PLACES.lock().unwrap() += 1;
        PLACE_IS_FREE.notify_one();
    }
}

/// A browser process, killed when dropped.
pub(crate) struct Chromium {
    child: Child,
    socket: WebSocket<TcpStream>,
    calls: u64,
    /// The key that is held.
    held: Option<String>,
    /// A frame with a process of its own that it is attached to, by its target.
    frame: Option<(Value, Tab)>,
    _profile: tempfile::TempDir,
    _place: Place,
}

/// A tab.
#[derive(Debug, Clone)]
pub(crate) struct Tab(String);

impl Chromium {
    /// Starts a browser. `None` if this machine has none, which is printed; in CI it is a failure, so that a
    /// skipped test does not pass unnoticed.
    ///
    /// # Panics
    /// In CI, if there is no browser.
    #[allow(clippy::print_stdout, reason = "what is left out is said")]
    pub(crate) fn start() -> Option<Self> {
        let place = Place::take();
        let profile = tempfile::tempdir().unwrap();
        let child = Command::new("chromium")
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update"])
            .args(["--disable-sync", "--disable-quic", "--remote-debugging-port=0"])
            .args(["--window-size=1400,860", "--force-prefers-reduced-motion"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn();
        let Ok(mut child) = child else {
            assert!(std::env::var_os("CI").is_none(), "there is no chromium here");
            println!("skipped: there is no chromium here");
            return None;
        };
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines
            .find_map(|line| Some(line.unwrap().strip_prefix("DevTools listening on ")?.to_owned()))
            .expect("it tells where it listens");
        // Further messages must not fill the pipe.
        std::thread::spawn(move || lines.for_each(drop));
        let host = address.strip_prefix("ws://").unwrap().split('/').next().unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(address.as_str(), stream).unwrap();
        Some(Self {
            child,
            socket,
            calls: 0,
            held: None,
            frame: None,
            _profile: profile,
            _place: place,
        })
    }

    fn call(&mut self, tab: Option<&Tab>, method: &str, parameters: &Value) -> Value {
        let answer = self.answer(tab, method, parameters);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// The answer to a call, which may be an error.
    fn answer(&mut self, tab: Option<&Tab>, method: &str, parameters: &Value) -> Value {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(Tab(session)) = tab {
            call["sessionId"] = json!(session);
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
        loop {
            let message = match self.socket.read() {
                // A read with a time limit is interrupted where the machine is stopped and goes on.
                Err(tungstenite::Error::Io(error)) if error.kind() == ErrorKind::Interrupted => {
                    continue;
                }
                read => read.unwrap(),
            };
            let Message::Text(text) = message else { continue };
            let answer: Value = serde_json::from_str(&text).unwrap();
            if answer["id"] == self.calls {
                return answer;
            }
        }
    }

    /// Opens an address in a new tab.
    pub(crate) fn open(&mut self, url: &str) -> Tab {
        let target = self.call(None, "Target.createTarget", &json!({ "url": url }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = self.call(None, "Target.attachToTarget", &attach);
        Tab(session["sessionId"].as_str().unwrap().to_owned())
    }

    /// Reloads the page.
    pub(crate) fn reload(&mut self, tab: &Tab) {
        self.call(Some(tab), "Page.reload", &json!({}));
    }

    /// The value of an expression in the page.
    pub(crate) fn evaluate(&mut self, tab: &Tab, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true });
        let start = Instant::now();
        loop {
            let answer = self.answer(Some(tab), "Runtime.evaluate", &parameters);
            if answer["error"].is_null() {
                return answer["result"]["result"]["value"].clone();
            }
            // A page that is being loaded can evaluate nothing yet.
            let loads = answer["error"]["message"] == "Cannot find default execution context";
            assert!(loads && start.elapsed() < PATIENCE, "{expression:.200}: {answer}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The value that a promise in the page comes to.
    pub(crate) fn settle(&mut self, tab: &Tab, promise: &str) -> Value {
        let parameters =
            json!({ "expression": promise, "returnByValue": true, "awaitPromise": true });
        let result = self.call(Some(tab), "Runtime.evaluate", &parameters);
        assert!(result["exceptionDetails"].is_null(), "{promise:.200}: {result}");
        result["result"]["value"].clone()
    }

    /// Waits until a condition is true in the page.
    pub(crate) fn wait(&mut self, tab: &Tab, condition: &str) {
        let start = Instant::now();
        while self.evaluate(tab, condition) != json!(true) {
            if start.elapsed() > PATIENCE {
                let page = self.evaluate(tab, "document.body.innerText");
                // The text of a page is long, and in JSON it is one line.
                panic!("never so: {condition}: {page}");
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Waits until the frame of a page has the focus if the page says so, and else has not. One with a process of its own
    /// takes it, and gives it back, a moment later than the page; a key in between goes astray.
    pub(crate) fn wait_for_focus(&mut self, tab: &Tab) {
        let start = Instant::now();
        loop {
            let inside = "document.activeElement instanceof HTMLIFrameElement";
            let inside = self.evaluate(tab, inside) == json!(true);
            let Some(frame) = self.frame() else { return };
            if (self.evaluate(&frame, "document.hasFocus()") == json!(true)) == inside {
                return;
            }
            assert!(start.elapsed() < PATIENCE, "the focus is inside: {inside}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The frame with a process of its own, if there is one in any tab.
    fn frame(&mut self) -> Option<Tab> {
        let targets = self.call(None, "Target.getTargets", &json!({}));
        let targets = targets["targetInfos"].as_array().unwrap();
        let target = targets.iter().find(|target| target["type"] == "iframe")?["targetId"].clone();
        if self.frame.as_ref().is_none_or(|(known, _)| *known != target) {
            let attach = json!({ "targetId": target, "flatten": true });
            let session = self.call(None, "Target.attachToTarget", &attach);
            let frame = Tab(session["sessionId"].as_str().unwrap().to_owned());
            self.frame = Some((target, frame));
        }
        self.frame.as_ref().map(|(_, frame)| frame.clone())
    }

    /// Shows a tab that another one has covered.
    pub(crate) fn show(&mut self, tab: &Tab) {
        self.call(Some(tab), "Page.bringToFront", &json!({}));
    }

    /// Closes a tab.
    pub(crate) fn close(&mut self, tab: &Tab) {
        self.call(Some(tab), "Page.close", &json!({}));
    }

    /// Clicks with a mouse at an offset from the middle of an element.
    pub(crate) fn click(&mut self, tab: &Tab, selector: &str, off: [f64; 2]) {
        self.mouse(tab, selector, off, &["mousePressed", "mouseReleased"]);
    }

    /// Clicks a button that asks for a second click, and again when it has asked; then a condition must be true in the page. It
    /// waits for the second click for 2.5 s only: where the machine stood still for longer, that was a first one, after which
    /// the button has asked again.
    ///
    /// # Panics
    /// If it is not, or the button does not ask.
    pub(crate) fn confirm(&mut self, tab: &Tab, selector: &str, condition: &str) {
        let start = Instant::now();
        loop {
            self.watch(tab, selector);
            self.click(tab, selector, [0.0; 2]);
            self.wait(tab, "shown.length > 0 && shown[0].startsWith('Again')");
            self.click(tab, selector, [0.0; 2]);
            let clicked = Instant::now();
            while clicked.elapsed() < Duration::from_secs(10) {
                if self.evaluate(tab, condition) == json!(true) {
                    return;
                }
                std::thread::sleep(Duration::from_millis(50));
            }
            let asked = "shown.filter((text) => text.startsWith('Again')).length";
            let late = self.evaluate(tab, asked) == json!(2) && start.elapsed() < PATIENCE;
            assert!(late, "never so after two clicks: {condition}");
        }
    }

    /// Keeps in `shown` of the page whatever an element shows in place of what it shows now: what it shows for a moment only may
    /// be over when a test looks.
    pub(crate) fn watch(&mut self, tab: &Tab, selector: &str) {
        let watch = format!(
            "{{ watched?.disconnect(); \
             const element = document.querySelector('{selector}'); \
             let last = element.textContent; \
             shown = []; \
             watched = new MutationObserver(() => {{ \
             if (element.textContent !== last) shown.push(last = element.textContent); }}); \
             watched.observe(element, {{ childList: true, characterData: true, subtree: true }}); }} true"
        );
        self.evaluate(tab, &format!("var watched, shown; {watch}"));
    }

    /// Waits until the watched element has shown these texts and no other, one after the other.
    pub(crate) fn showed(&mut self, tab: &Tab, texts: &[&str]) {
        self.wait(tab, &format!("JSON.stringify(shown) === {}", json!(json!(texts).to_string())));
    }

    /// Pastes a text into what has the focus.
    pub(crate) fn insert(&mut self, tab: &Tab, selector: &str, text: &str) {
        self.evaluate(tab, &format!("document.querySelector('{selector}').focus(); true"));
        self.call(Some(tab), "Input.insertText", &json!({ "text": text }));
    }

    /// Presses a mouse's button and keeps it pressed.
    pub(crate) fn press(&mut self, tab: &Tab, selector: &str, off: [f64; 2]) {
        self.mouse(tab, selector, off, &["mousePressed"]);
    }

    /// Lets go of the mouse at an offset from the middle of an element.
    pub(crate) fn release(&mut self, tab: &Tab, selector: &str, off: [f64; 2]) {
        self.mouse(tab, selector, off, &["mouseReleased"]);
    }

    /// Drags an element with the mouse by an offset.
    pub(crate) fn drag(&mut self, tab: &Tab, selector: &str, by: [f64; 2]) {
        let [x, y] = self.middle(tab, selector);
        for (kind, part) in [
            ("mousePressed", 0.0),
            ("mouseMoved", 0.3),
            ("mouseMoved", 1.0),
            ("mouseReleased", 1.0),
        ] {
            let mouse = json!({
                "type": kind, "x": x + part * by[0], "y": y + part * by[1],
                "button": "left", "buttons": 1, "clickCount": 1,
            });
            self.call(Some(tab), "Input.dispatchMouseEvent", &mouse);
        }
    }

    /// Chooses an option of a list.
    pub(crate) fn choose(&mut self, tab: &Tab, selector: &str, value: &str) {
        let list = format!("document.querySelector('{selector}')");
        self.wait(
            tab,
            &format!("[...{list}.options].some((option) => option.value === '{value}')"),
        );
        let choose = format!("{list}.value = '{value}'; {list}.dispatchEvent(new Event('change'))");
        self.evaluate(tab, &choose);
    }

    /// Replaces the content of a field as if it was typed.
    pub(crate) fn type_into(&mut self, tab: &Tab, selector: &str, text: &str) {
        let field = format!("document.querySelector('{selector}')");
        self.evaluate(tab, &format!("{field}.focus(); {field}.select()"));
        self.call(Some(tab), "Input.insertText", &json!({ "text": text }));
    }

    /// Sets the size of the window and the colour scheme, light or dark.
    pub(crate) fn look(&mut self, tab: &Tab, [width, height]: [u32; 2], scheme: &str) {
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call(Some(tab), "Emulation.setDeviceMetricsOverride", &size);
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call(Some(tab), "Emulation.setEmulatedMedia", &json!({ "features": features }));
    }

    fn mouse(&mut self, tab: &Tab, selector: &str, off: [f64; 2], kinds: &[&str]) {
        let [x, y] = self.middle(tab, selector);
        let [x, y] = [x + off[0], y + off[1]];
        for kind in kinds {
            let mouse = json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1 });
            self.call(Some(tab), "Input.dispatchMouseEvent", &mouse);
        }
    }

    /// The middle of an element that has come to rest.
    pub(crate) fn middle(&mut self, tab: &Tab, selector: &str) -> [f64; 2] {
        let middle = format!(
            "{{ const box = document.querySelector('{selector}').getBoundingClientRect(); \
             [box.x + box.width / 2, box.y + box.height / 2] }}"
        );
        let (start, mut last) = (Instant::now(), [f64::NAN; 2]);
        loop {
            assert!(start.elapsed() < PATIENCE, "{selector} does not come to rest");
            let place = self.evaluate(tab, &middle);
            // It may not be there yet.
            let now = [0, 1].map(|axis| place[axis].as_f64().unwrap_or(f64::NAN));
            if now.iter().zip(last).all(|(now, last)| (now - last).abs() < 0.5) {
                return now;
            }
            last = now;
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Presses (`keyDown`) or releases (`keyUp`) a key, by its place on the keyboard.
    pub(crate) fn key(&mut self, tab: &Tab, kind: &str, code: &str) {
        // The name of a key other than a letter is its place.
        let key = json!({ "type": kind, "code": code, "key": code });
        self.call(Some(tab), "Input.dispatchKeyEvent", &key);
    }

    /// Presses and releases a key by its character; `modifiers`: 2 is Ctrl, 8 is Shift.
    pub(crate) fn strike(&mut self, tab: &Tab, key: &str, code: &str, modifiers: u32) {
        // Chromium acts by itself on the number of a key.
        let number = if key == "Escape" { 27 } else { 0 };
        for kind in ["rawKeyDown", "keyUp"] {
            let event = json!({
                "type": kind, "key": key, "code": code, "modifiers": modifiers,
                "windowsVirtualKeyCode": number,
            });
            self.call(Some(tab), "Input.dispatchKeyEvent", &event);
        }
    }

    /// Presses and releases a key as a keyboard does, with the text that it writes: one of a character, or `Tab`, `Enter`,
    /// `Escape`, `ArrowDown`. `modifiers`: 2 is Ctrl, 8 is Shift.
    ///
    /// # Panics
    /// If the key is another one.
    pub(crate) fn type_key(&mut self, tab: &Tab, key: &str, modifiers: u32) {
        let letter = key.chars().next().unwrap();
        let (number, text) = match key {
            "Tab" => (9, ""),
            "Enter" => (13, "\r"),
            "Escape" => (27, ""),
            "ArrowLeft" => (37, ""),
            "ArrowUp" => (38, ""),
            "ArrowRight" => (39, ""),
            "ArrowDown" => (40, ""),
            "." => (190, key),
            "-" => (189, key),
            "+" => (187, key),
            "?" => (191, key),
            _ if key.len() == 1 => (u32::from(letter.to_ascii_uppercase()), key),
            _ => panic!("{key} is not known here"),
        };
        let code = match letter.to_ascii_uppercase() {
            _ if key.len() > 1 => key.to_owned(),
            ' ' => "Space".to_owned(),
            letter if letter.is_ascii_alphabetic() => format!("Key{letter}"),
            digit if digit.is_ascii_digit() => format!("Digit{digit}"),
            _ => String::new(),
        };
        // With Ctrl nothing is written.
        let text = if modifiers & 2 == 0 { text } else { "" };
        for kind in [if text.is_empty() { "rawKeyDown" } else { "keyDown" }, "keyUp"] {
            let mut event = json!({
                "type": kind, "key": key, "code": code, "modifiers": modifiers,
                "windowsVirtualKeyCode": number,
            });
            if kind == "keyDown" {
                event["text"] = json!(text);
            }
            self.call(Some(tab), "Input.dispatchKeyEvent", &event);
        }
    }

    /// Touches with fingers at places of the window, in pixels: `touchStart`, `touchMove`, or none with `touchEnd`.
    pub(crate) fn touch(&mut self, tab: &Tab, kind: &str, fingers: &[[f64; 2]]) {
        let fingers: Vec<Value> = (fingers.iter().enumerate())
            .map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }))
            .collect();
        let event = json!({ "type": kind, "touchPoints": fingers });
        self.call(Some(tab), "Input.dispatchTouchEvent", &event);
    }

    /// Presses a key, or repeats one that is pressed already.
    pub(crate) fn hold_key(&mut self, tab: &Tab, key: &str, code: &str) {
        let repeats = self.held.as_deref() == Some(code);
        self.held = Some(code.to_owned());
        let event = json!({
            "type": "keyDown", "key": key, "code": code, "autoRepeat": repeats,
            "text": if key == "Enter" { "\r" } else { "" },
            "windowsVirtualKeyCode": if key == "Enter" { 13 } else { 0 },
        });
        self.call(Some(tab), "Input.dispatchKeyEvent", &event);
    }

    /// Turns a mouse's wheel at an offset from the middle of an element; positive moves away.
    pub(crate) fn wheel(&mut self, tab: &Tab, selector: &str, off: [f64; 2], by: f64) {
        let [x, y] = self.middle(tab, selector);
        let event = json!({
            "type": "mouseWheel", "x": x + off[0], "y": y + off[1], "deltaX": 0, "deltaY": by,
        });
        self.call(Some(tab), "Input.dispatchMouseEvent", &event);
    }

    /// Saves a screenshot to the folder `PAGE_PICTURES`, if it is given.
    pub(crate) fn picture(&mut self, tab: &Tab, name: &str) {
        if let Some(folder) = std::env::var_os("PAGE_PICTURES") {
            std::thread::sleep(Duration::from_millis(300));
            self.screenshot(tab, &Path::new(&folder).join(format!("{name}.png")));
        }
    }

    /// Saves a screenshot.
    pub(crate) fn screenshot(&mut self, tab: &Tab, file: &Path) {
        let picture = self.call(Some(tab), "Page.captureScreenshot", &json!({ "format": "png" }));
        let bytes = BASE64_STANDARD.decode(picture["data"].as_str().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        // The process may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}
