//! The command `photinus`: arguments in, exit codes out; the work is done by the library of the same name.

mod allocator;
mod args;
mod commands;
mod failure;
mod interrupt;
mod progress;
mod report;

use args::{Cli, Command};
use clap::Parser;
use failure::{Failure, Outcome};
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let begun = Instant::now();
    allocator::prepare();
    quiet_decoders();
    let outcome = match Cli::parse().command {
        Command::Render(args) => commands::render::run(&args, begun),
        Command::Info(args) => commands::info::run(&args),
        Command::Scenes(args) => commands::scenes::run(&args),
        Command::Tree(args) => commands::tree::run(&args),
        Command::Compare(args) => commands::compare::run(&args),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Interrupted) => ExitCode::from(interrupt::EXIT_CODE),
        // Whoever reads our output went away: nothing is wrong, and nobody is there to be told.
        Err(Failure::OutputClosed) => ExitCode::SUCCESS,
        Err(Failure::Input(message)) => fail(&message, 1),
        Err(Failure::Usage(message)) => fail(&message, 2),
    }
}

/// What makes a decoder give up is in the error that follows; its own message would be two lines for somebody else.
fn quiet_decoders() {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !photinus::image::is_decoding() {
            hook(panic);
        }
    }));
}

fn fail(message: &str, code: u8) -> ExitCode {
    report::error(message);
    ExitCode::from(code)
}
