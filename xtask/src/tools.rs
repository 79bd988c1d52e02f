//! Tools that the checks need beside cargo, how to see that they are there, and how to install them.

use crate::Failure;
use std::ffi::OsString;
use std::process::{Command, Stdio};

/// How a tool is installed.
enum Install {
    /// A component of the pinned toolchain.
    Rustup(&'static str),
    /// Debian packages, with spaces between.
    Apt(&'static str),
}

/// A tool.
struct Tool {
    name: &'static str,
    /// A command that succeeds where the tool works.
    probe: &'static [&'static str],
    install: Install,
}

const TOOLS: &[Tool] = &[
    Tool { name: "a C linker", probe: &["cc", "--version"], install: Install::Apt("gcc libc6-dev") },
    Tool { name: "valgrind", probe: &["valgrind", "--version"], install: Install::Apt("valgrind") },
    Tool { name: "rustfmt", probe: &["cargo", "fmt", "--version"], install: Install::Rustup("rustfmt") },
    Tool { name: "clippy", probe: &["cargo", "clippy", "--version"], install: Install::Rustup("clippy") },
];

/// The cargo that runs this program, or the one on the path.
pub fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Makes sure that every tool works: installs what is missing where `install` gives consent, else fails with the lines
/// that install it. System packages that are ever installed are the C linker, which rustc calls, and valgrind, which
/// counts instructions.
pub fn ensure(install: bool) -> Result<(), Failure> {
    let missing: Vec<&Tool> = TOOLS.iter().filter(|tool| !works(tool)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    if !install {
        let lines: Vec<String> =
            missing.iter().map(|tool| format!("  {} is missing: {}", tool.name, command_line(tool))).collect();
        return Err(format!("{}\nor let `cargo xtask ci --install` do it", lines.join("\n")));
    }
    for tool in missing {
        let line = command_line(tool);
        let status = Command::new("sh")
            .args(["-c", &line])
            .env("DEBIAN_FRONTEND", "noninteractive")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .status()
            .map_err(|e| format!("`{line}` could not be started: {e}"))?;
        if !status.success() || !works(tool) {
            return Err(format!("{} is missing and `{line}` did not install it; install it by hand", tool.name));
        }
    }
    Ok(())
}

fn works(tool: &Tool) -> bool {
    let (program, arguments) = tool.probe.split_first().expect("a probe names a program");
    Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// The shell line that installs a tool; as root without sudo.
fn command_line(tool: &Tool) -> String {
    match tool.install {
        Install::Rustup(component) => format!("rustup component add {component}"),
        Install::Apt(packages) => {
            let sudo = if is_root() { "" } else { "sudo " };
            format!("{sudo}apt-get update && {sudo}apt-get install -y --no-install-recommends {packages}")
        }
    }
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_tool_is_seen_and_its_line_says_how_to_get_it() {
        let tool = Tool { name: "x", probe: &["photinus-no-such-program"], install: Install::Rustup("x") };
        assert!(!works(&tool));
        assert_eq!(command_line(&tool), "rustup component add x");
        let tool = Tool { name: "x", probe: &["true"], install: Install::Apt("gcc") };
        assert!(works(&tool));
        assert!(command_line(&tool).ends_with("apt-get install -y --no-install-recommends gcc"));
    }
}
