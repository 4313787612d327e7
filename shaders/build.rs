//! Links the WGSL modules of this folder into one source per kernel and validates each, so that a mistake in a shader
//! fails the build with the name of the module's file.

use std::{env, error::Error, fs, path::PathBuf};

use naga::valid::{Capabilities, ValidationFlags, Validator};
use wesl::{BasicSourceMap, FileResolver, ManglerKind, ModulePath, SourceMap, Wesl};

/// The root modules: one file per pass.
const KERNELS: [&str; 10] =
    ["photons", "camera", "bake", "resolve", "smooth", "probe", "errors", "display", "intersect", "loop_check"];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let output = PathBuf::from(env::var("OUT_DIR")?);
    for entry in fs::read_dir(&folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "wgsl") || (path.is_dir() && !path.ends_with("src")) {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    let mut compiler = Wesl::new_barebones().set_custom_resolver(FileResolver::new(&folder));
    // Declarations keep their names, so that error messages and reflection tests can speak of them.
    compiler.set_mangler(ManglerKind::None).use_sourcemap(true).use_imports(true).use_stripping(true);
    for kernel in KERNELS {
        let source = link(&compiler, kernel)?;
        fs::write(output.join(kernel).with_extension("wgsl"), source)?;
    }
    Ok(())
}

/// Links and validates one kernel.
fn link(compiler: &Wesl<FileResolver>, kernel: &str) -> Result<String, String> {
    let root: ModulePath = format!("package::{kernel}").parse().map_err(|error| format!("{kernel}: {error}"))?;
    let linked = compiler.compile(&root).map_err(|error| format!("shaders/{kernel}.wgsl does not link:\n{error}"))?;
    let source = linked.syntax.to_string();
    let module = naga::front::wgsl::parse_str(&source).map_err(|error| {
        describe(kernel, &linked.sourcemap, &source, error.location(&source), error.emit_to_string(&source))
    })?;
    Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16_IN_FLOAT32).validate(&module).map_err(
        |error| {
            let text = error.emit_to_string(&source);
            describe(kernel, &linked.sourcemap, &source, error.location(&source), text)
        },
    )?;
    Ok(source)
}

/// A naga error with the file of the declaration that it is in.
fn describe(
    kernel: &str,
    map: &Option<BasicSourceMap>,
    source: &str,
    location: Option<naga::SourceLocation>,
    text: String,
) -> String {
    let offset = location.map_or(0, |at| at.offset as usize).min(source.len());
    let end = source[offset..].find('\n').map_or(source.len(), |length| offset + length);
    let declaration = source[..end]
        .lines()
        .rfind(|line| line.starts_with("fn ") || line.starts_with("struct "))
        .and_then(|line| line.split([' ', '(', '{']).nth(1));
    let file = declaration
        .zip(map.as_ref())
        .and_then(|(name, map)| map.get_decl(name))
        .map_or(format!("shaders/{kernel}.wgsl"), |(path, _)| format!("shaders/{}.wgsl", path.components.join("/")));
    format!("{file}, linked into kernel {kernel}: {text}")
}
