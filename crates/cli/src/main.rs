//! The command `diacaustic`.

use std::process::ExitCode;

fn main() -> ExitCode {
    // SAFETY: no other thread runs yet that could read the environment.
    #[cfg(target_os = "linux")]
    unsafe {
        skip_device_selection();
    }
    diacaustic_cli::main(std::env::args_os())
}

/// Where there is no Wayland session, keeps Mesa's device selection layer from looking for one, for it would print an error
/// among ours. wgpu chooses the device itself.
///
/// # Safety
/// No other thread may run.
#[cfg(target_os = "linux")]
unsafe fn skip_device_selection() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: the caller's.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
