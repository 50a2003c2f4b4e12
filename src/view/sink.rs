//! Where the stream goes: a file, a viewer window, or a loopback server.

use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::time::Duration;

use rerun::{RecordingStream, RecordingStreamBuilder, ServerOptions, SpawnError, SpawnOptions};

use super::error::ViewError;
use super::file::StreamFile;
use super::options::Pace;

/// Port of Rerun viewers unless told otherwise.
pub const DEFAULT_PORT: u16 = rerun::DEFAULT_SERVER_PORT;

/// Only this machine: a run is nobody else's business unless the user forwards the port.
const LOOPBACK: &str = "127.0.0.1";

const APPLICATION: &str = "smam";

/// Where a run is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ViewSink {
    /// Save to this `.rrd` file, which appears when it is complete.
    File(PathBuf),
    /// Open a viewer window on this machine (or use the one that is open).
    Window,
    /// Wait on 127.0.0.1 for a viewer to connect; port 0 picks a free one.
    Serve { port: u16 },
}

/// An open stream and what to say about it.
pub(super) struct Connection {
    pub(super) stream: RecordingStream,
    pub(super) announcement: String,
    pub(super) pace: Pace,
    /// What the stream is written to, if to a file. Last: the stream lets go of it first.
    pub(super) file: Option<StreamFile>,
}

impl ViewSink {
    pub(super) fn open(&self) -> Result<Connection, ViewError> {
        match self {
            ViewSink::File(path) => open_file(path),
            ViewSink::Window => open_window(),
            ViewSink::Serve { port } => serve(*port),
        }
    }
}

/// `RERUN=off` in the environment must not silently turn an explicit request into nothing.
fn builder() -> RecordingStreamBuilder {
    RecordingStreamBuilder::new(APPLICATION).enabled(true)
}

fn open_file(path: &std::path::Path) -> Result<Connection, ViewError> {
    let file = StreamFile::beside(path)?;
    let stream = builder().save(file.temporary()).map_err(|error| ViewError::opening(path, error))?;
    Ok(Connection {
        stream,
        announcement: format!("{0}: open it with `rerun {0}`", path.display()),
        pace: Pace::Frames(1024),
        file: Some(file),
    })
}

fn open_window() -> Result<Connection, ViewError> {
    require_display()?;
    let info = rerun::spawn(&window_options()).map_err(spawn_error)?;
    let url = proxy_url(info.port);
    let stream = builder().connect_grpc_opts(url.as_str())?;
    Ok(Connection { stream, announcement: format!("viewer at {url}"), pace: live_pace(), file: None })
}

/// The viewer listens on all interfaces unless told otherwise.
fn window_options() -> SpawnOptions {
    SpawnOptions {
        wait_for_bind: true,
        hide_welcome_screen: true,
        extra_args: vec![format!("--bind={LOOPBACK}")],
        ..SpawnOptions::default()
    }
}

fn spawn_error(error: SpawnError) -> ViewError {
    match error {
        SpawnError::ExecutableNotFoundInPath { .. } | SpawnError::ExecutableNotFound { .. } => {
            ViewError::ViewerNotFound
        }
        SpawnError::Io(source) => ViewError::ViewerFailed { detail: source.to_string() },
    }
}

fn require_display() -> Result<(), ViewError> {
    let unset = |name| std::env::var_os(name).is_none_or(|value| value.is_empty());
    if cfg!(target_os = "linux") && unset("DISPLAY") && unset("WAYLAND_DISPLAY") {
        return Err(ViewError::NoDisplay);
    }
    Ok(())
}

fn serve(port: u16) -> Result<Connection, ViewError> {
    let port = free_port(port)?;
    let stream = builder().serve_grpc_opts(LOOPBACK, port, ServerOptions::default())?;
    let url = proxy_url(port);
    let announcement = format!("serving at {url}: open it with `rerun {url}`");
    Ok(Connection { stream, announcement, pace: live_pace(), file: None })
}

/// Rerun binds in a thread of its own and would only log a taken port; so try it first.
fn free_port(port: u16) -> Result<u16, ViewError> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .and_then(|listener| listener.local_addr())
        .map(|address| address.port())
        .map_err(|source| ViewError::PortTaken { port, source })
}

fn proxy_url(port: u16) -> String {
    format!("rerun+http://{LOOPBACK}:{port}/proxy")
}

fn live_pace() -> Pace {
    Pace::Wall(Duration::from_millis(33))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_taken_port_is_named_with_its_remedy() {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let error = ViewSink::Serve { port }.open().err().unwrap().to_string();
        assert!(error.contains(&port.to_string()) && error.contains("0 picks"), "{error}");
    }

    #[test]
    fn serving_announces_the_loopback_address_and_the_command() {
        let connection = ViewSink::Serve { port: 0 }.open().unwrap();
        assert!(connection.announcement.contains("`rerun rerun+http://127.0.0.1:"));
    }

    #[test]
    fn a_window_of_ours_listens_on_loopback_only() {
        assert_eq!(window_options().extra_args, ["--bind=127.0.0.1"]);
    }

    #[test]
    fn an_impossible_file_is_named() {
        let file = ViewSink::File("/nonexistent-folder/a.rrd".into());
        let error = file.open().err().unwrap().to_string();
        assert!(error.contains("/nonexistent-folder/a.rrd: cannot write"), "{error}");
    }

    #[test]
    fn a_missing_viewer_tells_how_to_install_it() {
        let options =
            SpawnOptions { executable_name: "no-such-rerun".into(), port: free_port(0).unwrap(), ..window_options() };
        let error = spawn_error(rerun::spawn(&options).unwrap_err()).to_string();
        assert!(error.contains("pip install rerun-sdk==0.36.3"), "{error}");
    }
}
