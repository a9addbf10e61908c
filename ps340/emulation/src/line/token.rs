//! Who may give operator commands over a network: whoever knows the token.

use std::{
    fs::File,
    io::{self, Read},
};

/// The environment variable with the token: of a machine that is started, instead of one that it makes, and of programs
/// that give it operator commands.
pub const TOKEN_VARIABLE: &str = "PS340_TOKEN";
/// The word before the token in the first line that an operator sends.
const WORD: &str = "token ";
/// Bytes of chance in a token.
const TOKEN_BYTES: usize = 16;

/// A secret that operators must send before their first operator command.
#[derive(Clone, PartialEq, Eq)]
pub struct Token {
    text: String,
    /// Whether the machine made it, and must announce it once.
    is_own: bool,
}

impl std::fmt::Debug for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Token")
    }
}

impl Token {
    /// The token of the environment, or else a new one.
    ///
    /// # Errors
    /// Those of the source of chance.
    pub fn begin() -> io::Result<Token> {
        if let Some(text) = std::env::var(TOKEN_VARIABLE).ok().filter(|text| !text.trim().is_empty()) {
            return Ok(Token { text: text.trim().into(), is_own: false });
        }
        let mut bytes = [0; TOKEN_BYTES];
        File::open("/dev/urandom")?.read_exact(&mut bytes)?;
        let text = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Token { text, is_own: true })
    }

    /// The text of a token that nobody knows yet.
    pub fn unannounced(&self) -> Option<&str> {
        self.is_own.then_some(&self.text)
    }

    /// Whether a line matches the token. It takes as long for a wrong one as for a nearly right one.
    pub(super) fn matches(&self, line: &str) -> bool {
        let told = line.trim().strip_prefix(WORD).unwrap_or_default().trim().as_bytes();
        let differences = told.iter().zip(self.text.as_bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        told.len() == self.text.len() && differences == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_token_itself_opens_the_line() {
        let token = Token { text: "a1b2".into(), is_own: true };
        assert!(token.matches("token a1b2") && token.matches(" token  a1b2\r"));
        for line in ["", "token", "token ", "token a1b", "token a1b2c", "token a1b3", "a1b2", "dial 1 0.1"] {
            assert!(!token.matches(line), "{line}");
        }
        assert_eq!(token.unannounced(), Some("a1b2"));
    }
}
