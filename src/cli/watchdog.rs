use super::stop::Stop;
use super::terminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Ends the process when it is not dropped in time.
///
/// It keeps a thread of its own, which computes nothing: no work in progress has to ask for the time.
pub(super) struct Watchdog {
    _leash: Sender<()>,
}

impl Watchdog {
    pub(super) fn start(limit: Duration) -> Watchdog {
        let (leash, slipped) = channel();
        std::thread::spawn(move || {
            if slipped.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                let stop = Stop::Limit(Some(format!("stopped after {} s", limit.as_secs_f64())));
                terminal::explain_plainly(&stop);
                std::process::exit(stop.code().into());
            }
        });
        Watchdog { _leash: leash }
    }
}
