//! A tab of a browser, spoken to by the protocol of its developer tools: in real time, which a worker needs.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Longer than a test may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(180);

/// A browser with one tab, ended when dropped.
pub(crate) struct Tab {
    browser: Child,
    stream: TcpStream,
    calls: u64,
    errors: Vec<String>,
}

impl Drop for Tab {
    fn drop(&mut self) {
        self.browser.kill().ok();
        self.browser.wait().ok();
    }
}

impl Tab {
    pub(crate) fn open(browser: &Path, profile: &Path) -> Self {
        let mut browser = Command::new(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--no-first-run",
            ])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .arg(format!("--user-data-dir={}", profile.display()))
            .args(["--remote-debugging-port=0", "--window-size=1400,1200", "about:blank"])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("an installed browser starts");
        let told = BufReader::new(browser.stderr.take().expect("piped"));
        let mut lines = told.lines().map_while(Result::ok);
        let line = lines.find(|line| line.contains("ws://")).expect("the browser listens");
        // Its further output must be read, or it blocks.
        std::thread::spawn(move || lines.for_each(drop));
        let host = line
            .split("ws://")
            .nth(1)
            .and_then(|rest| rest.split('/').next())
            .expect("an address")
            .to_owned();
        let tab = tab_address(&host);
        let stream = connect(&host, &tab);
        let mut tab = Self { browser, stream, calls: 0, errors: Vec::new() };
        for domain in ["Runtime.enable", "Log.enable", "Page.enable"] {
            tab.call(domain, json!({}));
        }
        tab
    }

    /// Opens a page and waits until all of it is there.
    pub(crate) fn go_to(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
        let there =
            json!({ "expression": "location.href !== 'about:blank' && document.readyState === 'complete'" });
        let started = Instant::now();
        while self.call("Runtime.evaluate", there.clone())["result"]["value"] != true {
            assert!(started.elapsed() < PATIENCE, "{address} does not load");
            sleep(Duration::from_millis(20));
        }
    }

    pub(crate) fn answer(&mut self, script: &str) -> Value {
        let said = self.call(
            "Runtime.evaluate",
            json!({ "expression": script, "awaitPromise": true, "returnByValue": true }),
        );
        assert!(said.get("exceptionDetails").is_none(), "{said}");
        said["result"]["value"].clone()
    }

    /// Errors in the page's console.
    pub(crate) fn errors(&self) -> Vec<String> {
        self.errors.clone()
    }

    /// What the browser answers to a call of its protocol.
    pub(crate) fn call(&mut self, method: &str, params: Value) -> Value {
        self.calls += 1;
        let id = self.calls;
        send(&mut self.stream, &json!({ "id": id, "method": method, "params": params }).to_string());
        let started = Instant::now();
        while started.elapsed() < PATIENCE {
            let message: Value = serde_json::from_str(&receive(&mut self.stream)).expect("JSON");
            if message["id"] == id {
                return message["result"].clone();
            }
            let params = &message["params"];
            let wrong = match message["method"].as_str() {
                Some("Runtime.exceptionThrown") => true,
                Some("Runtime.consoleAPICalled") => params["type"] == "error",
                Some("Log.entryAdded") => params["entry"]["level"] == "error",
                _ => false,
            };
            if wrong {
                self.errors.push(params.to_string());
            }
        }
        panic!("{method} has no answer after {PATIENCE:?}");
    }
}

/// Path of the one page, from the browser's list.
fn tab_address(host: &str) -> String {
    let started = Instant::now();
    while started.elapsed() < PATIENCE {
        let mut stream = TcpStream::connect(host).expect("the browser listens");
        write!(stream, "GET /json HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").expect("sent");
        // The browser keeps the connection open: the answer ends where nothing more arrives.
        stream.set_read_timeout(Some(Duration::from_millis(300))).expect("a time limit");
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).ok();
        let text = String::from_utf8_lossy(&bytes);
        let list = text.find("\r\n\r\n").and_then(|at| serde_json::from_str::<Value>(text[at..].trim()).ok());
        let page = list.as_ref().and_then(|list| list.as_array()?.iter().find(|tab| tab["type"] == "page"));
        if let Some(address) = page.and_then(|page| page["webSocketDebuggerUrl"].as_str()) {
            return address.trim_start_matches("ws://").trim_start_matches(host).to_owned();
        }
        sleep(Duration::from_millis(100));
    }
    panic!("the browser has no page");
}

/// A web socket (RFC 6455): its handshake with the key of the standard's example.
fn connect(host: &str, path: &str) -> TcpStream {
    let mut stream = TcpStream::connect(host).expect("the browser listens");
    stream.set_read_timeout(Some(PATIENCE)).expect("a time limit");
    let key = "dGhlIHNhbXBsZSBub25jZQ==";
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
    )
    .expect("sent");
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).expect("a handshake");
        head.push(byte[0]);
    }
    assert!(head.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&head));
    stream
}

/// One text frame under a mask of zeros, which leaves it as it is.
fn send(stream: &mut TcpStream, text: &str) {
    let mut frame = vec![0x81];
    match text.len() {
        short @ 0..126 => frame.push(0x80 | short as u8),
        long => {
            frame.push(0x80 | 127);
            frame.extend((long as u64).to_be_bytes());
        }
    }
    frame.extend([0; 4]);
    frame.extend(text.as_bytes());
    stream.write_all(&frame).expect("sent");
}

/// The next text, from one frame or several.
fn receive(stream: &mut TcpStream) -> String {
    let mut text = Vec::new();
    loop {
        let mut head = [0; 2];
        stream.read_exact(&mut head).expect("the browser answers in time");
        let length = match head[1] & 0x7f {
            126 => {
                let mut long = [0; 2];
                stream.read_exact(&mut long).expect("a length");
                usize::from(u16::from_be_bytes(long))
            }
            127 => {
                let mut long = [0; 8];
                stream.read_exact(&mut long).expect("a length");
                u64::from_be_bytes(long) as usize
            }
            short => usize::from(short),
        };
        let mut part = vec![0; length];
        stream.read_exact(&mut part).expect("a frame");
        // Texts alone and what continues them; a browser that pings is not answered, and does not mind.
        if matches!(head[0] & 0x0f, 0 | 1) {
            text.extend(part);
            if head[0] & 0x80 != 0 {
                return String::from_utf8(text).expect("UTF-8");
            }
        }
    }
}
