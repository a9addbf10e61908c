//! Cases as plain data.

/// How sure the reference is of what a case proves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Tag {
    /// Confirmed by running code of the time.
    S,
    /// Remembered from the manuals.
    M,
    /// Uncertain.
    U,
    /// A choice of this machine.
    C,
}

impl Tag {
    /// Every tag.
    pub const ALL: [Tag; 4] = [Tag::S, Tag::M, Tag::U, Tag::C];

    /// Its letter.
    pub fn letter(self) -> &'static str {
        match self {
            Tag::S => "S",
            Tag::M => "M",
            Tag::U => "U",
            Tag::C => "C",
        }
    }
}

/// One case: steps in order, each with the line where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name: letters, digits, `-`, `_` and `.`; unique in the suite.
    pub id: String,
    /// What it proves, as a sentence.
    pub title: String,
    /// The section of the reference, such as `B.4`.
    pub section: String,
    /// How sure the reference is.
    pub tag: Tag,
    /// Numbers of facts that it proves, such as `3.4`: section and number of the client facts.
    pub facts: Vec<String>,
    /// Its commands are about the text form itself, and are sent as they stand.
    pub text_only: bool,
    /// It takes seconds, and is played only when long cases are asked for.
    pub is_long: bool,
    /// Allowed difference of numbers, absolute and relative.
    pub tolerance: f64,
    /// What is done and expected.
    pub steps: Vec<(usize, Step)>,
    /// The file.
    pub file: String,
    /// Where it begins.
    pub line: usize,
}

impl Case {
    /// A case without steps.
    pub fn new(id: &str, title: &str, section: &str, tag: Tag) -> Case {
        Case {
            id: id.into(),
            title: title.into(),
            section: section.into(),
            tag,
            facts: Vec::new(),
            text_only: false,
            is_long: false,
            tolerance: DEFAULT_TOLERANCE,
            steps: Vec::new(),
            file: String::new(),
            line: 0,
        }
    }

    /// Whether someone must be at the machine. Strokes of one frame can also be asked for over the host line.
    pub fn needs_operator(&self) -> bool {
        let needs = |step: &Step| match step {
            Step::OperatorCommand(_) | Step::Reply(_) => true,
            Step::Strokes { frames, .. } => *frames > 1,
            _ => false,
        };
        self.steps.iter().any(|(_, step)| needs(step))
    }

    /// Whether warnings of the machine are messages of this case.
    pub fn wants_warnings(&self) -> bool {
        self.steps.iter().any(|(_, step)| matches!(step, Step::Expect(Expected::Fault { class: 'W', .. })))
    }

    /// All text that is sent, without what the runner adds; of repeated commands the first.
    pub fn text(&self) -> String {
        let sent = self.steps.iter().filter_map(|(_, step)| match step {
            Step::Send(text) => Some(text.clone()),
            Step::Each { first, text, .. } => Some(with_number(text, *first)),
            _ => None,
        });
        sent.collect()
    }
}

/// Commands in which a number stands for `#`, and the next for `##`.
pub fn with_number(text: &str, number: usize) -> String {
    text.replace("##", &(number + 1).to_string()).replace('#', &number.to_string())
}

/// The tolerance of a case that gives none.
pub const DEFAULT_TOLERANCE: f64 = 1e-6;

/// Something to do, or to expect.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// `> text`: commands, with the line ends.
    Send(String),
    /// `each 1 9 text`: the same commands for each number.
    Each {
        /// The first number.
        first: usize,
        /// The last.
        last: usize,
        /// The commands, with their line end, for [`with_number`].
        text: String,
    },
    /// `raw "..."`: bytes on the line as they are.
    Raw(Vec<u8>),
    /// `watch NAME<1> [as WORD]`: from now on each message of the output is printed and sent to the host.
    Watch {
        /// The object.
        name: String,
        /// Its output.
        output: u16,
        /// What stands before its messages, if several outputs are watched.
        word: Option<String>,
    },
    /// The next message.
    Expect(Expected),
    /// `@ ORDER`: an operator command, something that a person does.
    OperatorCommand(String),
    /// `@~ glob`: what the person saw.
    Reply(String),
    /// `frames N`: time passes.
    Frames(u64),
    /// `strokes [N [over M]]` and `/` lines: what is drawn on the vector screen.
    Strokes {
        /// How many; of any number if none.
        count: Option<usize>,
        /// In how many frames together.
        frames: u64,
        /// All of them, in order, or empty if only their number counts.
        lines: Vec<StrokeLine>,
    },
    /// `drop`: messages that are there do not matter.
    Drop,
    /// `quiet`: no message is there.
    Silence,
}

/// What a message must be.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// `< text`: exactly this.
    Exact(Vec<u8>),
    /// `<= text`: the same words, and the same numbers within the tolerance; blanks and commas separate.
    Numbers(String),
    /// `<~ glob`: `*` stands for anything, `?` for one character.
    Glob(String),
    /// `<! [number] [glob]`: a numbered message of the machine.
    Fault {
        /// `E` error or `W` warning.
        class: char,
        /// Its number, if it matters.
        number: Option<u16>,
        /// A pattern of its text, after the number.
        text: Option<String>,
    },
    /// `<& N` and so many expectations: these messages in any order.
    AnyOrder(Vec<Expected>),
}

/// One stroke of the vector screen.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeLine {
    /// x and y of the start, -1..=1.
    pub start: [f64; 2],
    /// x and y of the end; the start for a dot.
    pub end: [f64; 2],
    /// Intensity at start and end, if it matters.
    pub intensity: Option<[f64; 2]>,
    /// Red, green and blue, if they matter.
    pub color: Option<[f64; 3]>,
}
