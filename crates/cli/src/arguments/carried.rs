//! Arguments of the commands that show what the program carries along.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `scenes`.
#[derive(Args, Debug)]
pub struct ScenesArguments {
    /// Only these files or folders, as in shop-window,gallery.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Copy them into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "json")]
    pub out: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `completions`.
#[derive(Args, Debug)]
pub struct CompletionsArguments {
    /// The shell.
    pub shell: clap_complete::Shell,
}

/// Arguments of `manual`.
#[derive(Args, Debug)]
pub struct ManualArguments {
    /// The command [default: all of them in short].
    pub command: Option<String>,
    /// Write a page for each command into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    pub out: Option<PathBuf>,
}

/// Arguments of `schema`.
#[derive(Args, Debug)]
pub struct SchemaArguments {
    /// Print a page in Markdown.
    #[arg(long)]
    pub markdown: bool,
}
