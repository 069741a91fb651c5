//! Where the server listens, and who may ask: loopback alone, unless another address of this machine is given, and
//! who was told the link.

use axum::http::{HeaderMap, header};
use std::net::{IpAddr, SocketAddr, TcpListener};

/// Ports tried after the one asked for.
const MORE_PORTS: u16 = 100;

/// Listens on a port of an address of this machine, or on the next one that is free; 0 stands for any.
///
/// # Errors
///
/// The last error, if none of them is free.
pub(crate) fn listen(host: IpAddr, port: u16) -> std::io::Result<TcpListener> {
    let last = if port == 0 { 0 } else { port.saturating_add(MORE_PORTS) };
    let mut result = Err(std::io::Error::from(std::io::ErrorKind::AddrInUse));
    for port in port..=last {
        result = TcpListener::bind(SocketAddr::from((host, port)));
        match &result {
            Err(error) if error.kind() == std::io::ErrorKind::AddrInUse => {}
            _ => break,
        }
    }
    result
}

/// The names under which the server answers.
#[derive(Clone, Debug)]
pub(crate) struct Names(Vec<String>);

impl Names {
    /// Those of an address; browsers leave the usual port out.
    pub fn of(address: SocketAddr) -> Self {
        let mut names = vec![address.to_string()];
        if address.ip().is_loopback() {
            names.push(format!("localhost:{}", address.port()));
        }
        if address.port() == 80 {
            let bare = |name: &String| name.strip_suffix(":80").map(str::to_owned);
            names.extend(names.clone().iter().filter_map(bare));
        }
        Self(names)
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

/// What the address has that nobody can guess, for everybody on this machine can reach the server
/// and say any name: 128 random bits in hexadecimal digits, the first folder of each path.
#[derive(Clone)]
pub(crate) struct Secret(String);

impl Secret {
    /// A new one.
    pub fn new() -> std::io::Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(std::io::Error::other)?;
        Ok(Self(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// The digits.
    pub fn digits(&self) -> &str {
        &self.0
    }

    /// The path within the secret folder; `None` where another one is asked for. How long the answer
    /// takes does not depend on how much of it is right.
    pub fn path_within<'p>(&self, path: &'p str) -> Option<&'p str> {
        let said = path.strip_prefix('/')?;
        let (said, within) = said.split_at(said.find('/')?);
        let differing = |sum: u8, (a, b): (u8, u8)| std::hint::black_box(sum | (a ^ b));
        let is_ours =
            said.len() == self.0.len() && said.bytes().zip(self.0.bytes()).fold(0, differing) == 0;
        is_ours.then_some(within)
    }
}

/// It is no business of any log.
impl std::fmt::Debug for Secret {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Secret")
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
        let names = Names::of(SocketAddr::from(([127, 0, 0, 1], 8420)));
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
    fn of_another_address_only_that_is_ours() {
        let names = |text: &str| Names::of(text.parse().expect("an address"));
        let has = |names: &Names, host: &str| names.host_is_ours(&with(header::HOST, host));
        let network = names("192.168.1.20:8420");
        assert!(has(&network, "192.168.1.20:8420"));
        for foreign in ["127.0.0.1:8420", "localhost:8420", "192.168.1.20", "192.168.1.21:8420"] {
            assert!(!has(&network, foreign), "{foreign}");
        }
        assert!(has(&names("[fd00::1]:8420"), "[fd00::1]:8420"));
        let usual = names("192.168.1.20:80");
        assert!(has(&usual, "192.168.1.20") && has(&usual, "192.168.1.20:80"));
    }

    #[test]
    fn only_the_secret_opens() {
        let (secret, other) = (Secret::new().expect("random"), Secret::new().expect("random"));
        let digits = secret.digits();
        assert!(digits.len() == 32 && digits != other.digits());
        assert_eq!(secret.path_within(&format!("/{digits}/")), Some("/"));
        assert_eq!(secret.path_within(&format!("/{digits}/a/b")), Some("/a/b"));
        for wrong in [
            String::new(),
            "/".to_owned(),
            "//".to_owned(),
            format!("/{digits}"),
            format!("{digits}/"),
            format!("//{digits}/"),
            format!("/{}/", &digits[1..]),
            format!("/{digits}0/"),
            format!("/{}/", digits.to_uppercase().replace(|c: char| c.is_ascii_digit(), "A")),
            format!("/{}/", other.digits()),
        ] {
            assert_eq!(secret.path_within(&wrong), None, "{wrong}");
        }
        assert!(!format!("{secret:?}").contains(digits));
    }

    #[test]
    fn a_port_that_is_taken_is_passed_over() {
        let host = IpAddr::from([127, 0, 0, 1]);
        let first = listen(host, 0).expect("a port");
        let port = first.local_addr().expect("an address").port();
        let second = listen(host, port).expect("the next one");
        let address = second.local_addr().expect("an address");
        assert!(address.ip().is_loopback() && address.port() > port);
    }
}
