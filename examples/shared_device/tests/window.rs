//! The window under Xvfb, photographed.

#![cfg(target_os = "linux")]

use std::{
    fs,
    path::Path,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// Ends a process when the test does.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// An X server without a screen, and its display's name.
fn server(folder: &Path) -> Option<(Process, String)> {
    let number_file = folder.join("display");
    let mut command = Command::new("sh");
    // The server writes the number of the display that it found free.
    let line = "exec Xvfb -displayfd 3 -screen 0 1000x700x24 -nolisten tcp 3>\"$0\" 2>/dev/null";
    command.args(["-c", line]).arg(&number_file);
    Command::new("Xvfb").arg("-version").stderr(Stdio::null()).status().ok()?;
    let process = Process(command.spawn().ok()?);
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(30) {
        match fs::read_to_string(&number_file) {
            Ok(number) if number.ends_with('\n') => return Some((process, format!(":{}", number.trim()))),
            _ => sleep(Duration::from_millis(20)),
        }
    }
    panic!("Xvfb does not start");
}

/// What the screen shows: width, height, and for each pixel red, green and blue.
fn photograph(display: &str) -> (usize, usize, Vec<[u8; 3]>) {
    let dump = Command::new("xwd").args(["-root", "-silent", "-display", display]).output().unwrap();
    assert!(dump.status.success(), "{}", String::from_utf8_lossy(&dump.stderr));
    // X11's XWDFile.h: 25 words, most significant byte first, then the window's name, colours and the rows.
    let word = |number: usize| u32::from_be_bytes(dump.stdout[4 * number..4 * number + 4].try_into().unwrap()) as usize;
    let (header, width, height, bytes_per_line, colors) = (word(0), word(4), word(5), word(12), word(19));
    assert_eq!((word(1), word(11), word(7)), (7, 32, 0), "not the version, depth or byte order that is read here");
    let rows = &dump.stdout[header + 12 * colors..];
    let pixel = |x: usize, y: usize| {
        let at = y * bytes_per_line + 4 * x;
        [rows[at + 2], rows[at + 1], rows[at]]
    };
    (width, height, (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect())
}

#[test]
fn the_window_shows_a_caustic() {
    let folder = std::env::temp_dir().join(format!("shared-device-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let (Some((_server, display)), true) =
        (server(&folder), Command::new("xwd").arg("-help").stderr(Stdio::null()).status().is_ok())
    else {
        eprintln!("skipped: Xvfb and xwd are missing (on Debian: apt-get install xvfb x11-apps)");
        return;
    };
    let mut window = Command::new(env!("CARGO_BIN_EXE_shared-device"));
    window.env("DISPLAY", &display).env_remove("WAYLAND_DISPLAY").current_dir(&folder);
    let mut window = Process(window.spawn().unwrap());
    let start = Instant::now();
    loop {
        assert!(start.elapsed() < Duration::from_secs(120), "the window shows no picture");
        assert!(window.0.try_wait().unwrap().is_none(), "the window has closed");
        sleep(Duration::from_millis(500));
        let (width, _, pixels) = photograph(&display);
        // The picture is on the right; warm light on the floor, and the caustic brighter than all of it.
        let right = pixels.iter().enumerate().filter(|(at, _)| at % width > width / 3).map(|(_, pixel)| *pixel);
        let lit = right.clone().filter(|[r, _, b]| *r > 60 && r > b).count();
        let bright = right.filter(|[r, g, _]| *r > 200 && *g > 180).count();
        if lit > 20_000 && bright > 200 {
            break;
        }
    }
    fs::remove_dir_all(&folder).unwrap();
}
