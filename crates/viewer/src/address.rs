//! Where the server listens, and who may ask: loopback alone.

use axum::http::{HeaderMap, header};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};

/// Ports tried after the one asked for.
const MORE_PORTS: u16 = 100;

/// Listens on a port of the loopback interface, or on the next one that is free; 0 stands for any.
///
/// # Errors
///
/// The last error, if none of them is free.
pub(crate) fn listen(port: u16) -> std::io::Result<TcpListener> {
    let last = if port == 0 { 0 } else { port.saturating_add(MORE_PORTS) };
    let mut result = Err(std::io::Error::from(std::io::ErrorKind::AddrInUse));
    for port in port..=last {
        result = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        match &result {
            Err(error) if error.kind() == std::io::ErrorKind::AddrInUse => {}
            _ => break,
        }
    }
    result
}

/// The names under which the server answers.
#[derive(Clone, Debug)]
pub(crate) struct Names([String; 2]);

impl Names {
    /// Those of a port.
    pub fn of(port: u16) -> Self {
        Self(["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}")))
    }

    /// Whether a request was meant for this server. A page from elsewhere whose name has been made
    /// to lead here (DNS rebinding) says another name.
    pub fn host_is_ours(&self, headers: &HeaderMap) -> bool {
        only(headers, &header::HOST).is_some_and(|host| self.has(host))
    }

    /// Whether a request comes from this server's own page; browsers say so with every WebSocket.
    pub fn origin_is_ours(&self, headers: &HeaderMap) -> bool {
        let host = only(headers, &header::ORIGIN).and_then(|origin| origin.strip_prefix("http://"));
        host.is_some_and(|host| self.has(host))
    }

    fn has(&self, host: &str) -> bool {
        self.0.iter().any(|ours| host.eq_ignore_ascii_case(ours))
    }
}

/// The text of a header that is there once.
fn only<'h>(headers: &'h HeaderMap, name: &header::HeaderName) -> Option<&'h str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn with(name: header::HeaderName, value: &str) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(name, HeaderValue::from_str(value).expect("a value"));
        headers
    }

    #[test]
    fn only_loopback_names_are_ours() {
        let names = Names::of(8420);
        for host in ["127.0.0.1:8420", "localhost:8420", "LocalHost:8420"] {
            assert!(names.host_is_ours(&with(header::HOST, host)), "{host}");
            let origin = format!("http://{host}");
            assert!(names.origin_is_ours(&with(header::ORIGIN, &origin)), "{origin}");
        }
        let foreign =
            ["127.0.0.1", "localhost:80", "evil.example:8420", "localhost:8420.evil.example", ""];
        for host in foreign {
            assert!(!names.host_is_ours(&with(header::HOST, host)), "{host}");
            let origin = format!("http://{host}");
            assert!(!names.origin_is_ours(&with(header::ORIGIN, &origin)), "{origin}");
        }
        for origin in ["null", "https://localhost:8420", "http://localhost:8420/", "file://"] {
            assert!(!names.origin_is_ours(&with(header::ORIGIN, origin)), "{origin}");
        }
        assert!(!names.host_is_ours(&HeaderMap::new()));
        assert!(!names.origin_is_ours(&HeaderMap::new()));
        let mut two = with(header::HOST, "localhost:8420");
        two.append(header::HOST, HeaderValue::from_static("evil.example"));
        assert!(!names.host_is_ours(&two));
    }

    #[test]
    fn a_port_that_is_taken_is_passed_over() {
        let first = listen(0).expect("a port");
        let port = first.local_addr().expect("an address").port();
        let second = listen(port).expect("the next one");
        let address = second.local_addr().expect("an address");
        assert!(address.ip().is_loopback() && address.port() > port);
    }
}
