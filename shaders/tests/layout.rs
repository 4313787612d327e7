//! The structs and constants of the two sides of the GPU are the same, and each kernel stays inside WebGPU's default limits.

use std::collections::HashMap;

use diacaustic_shaders::{KERNELS, SHARED_CONSTANTS, SHARED_STRUCTS, SharedStruct};
use naga::{AddressSpace, Literal, Module, TypeInner};

fn modules() -> Vec<(&'static str, Module)> {
    KERNELS
        .iter()
        .map(|kernel| (kernel.name, naga::front::wgsl::parse_str(kernel.source).expect(kernel.name)))
        .collect()
}

/// A field's name, offset and size.
type Field = (String, usize, usize);

/// The fields of a struct in WGSL, and its size.
fn fields(module: &Module, wanted: &str) -> Option<(Vec<Field>, usize)> {
    let (_, found) = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(wanted))?;
    let TypeInner::Struct { members, span } = &found.inner else { return None };
    let list = members
        .iter()
        .map(|member| {
            let size = module.types[member.ty].inner.size(module.to_ctx()) as usize;
            (member.name.clone().expect("fields have names"), member.offset as usize, size)
        })
        .collect();
    Some((list, *span as usize))
}

fn differences(shared: &SharedStruct, kernel: &str, module: &Module) -> Vec<String> {
    let Some((found, size)) = fields(module, shared.name) else { return Vec::new() };
    let expected: Vec<_> = shared.fields.iter().map(|f| (f.name.to_string(), f.offset, f.size)).collect();
    let mut list = Vec::new();
    if size != shared.size {
        list.push(format!("{kernel}: {} has {size} bytes in WGSL, {} in Rust", shared.name, shared.size));
    }
    for (wgsl, rust) in found.iter().zip(&expected) {
        if wgsl != rust {
            list.push(format!("{kernel}: {}: WGSL {wgsl:?}, Rust {rust:?}", shared.name));
        }
    }
    if found.len() != expected.len() {
        list.push(format!("{kernel}: {} has {} fields in WGSL, {} in Rust", shared.name, found.len(), expected.len()));
    }
    list
}

#[test]
fn structs_agree() {
    let modules = modules();
    let mut wrong = Vec::new();
    for shared in SHARED_STRUCTS {
        if !modules.iter().any(|(_, module)| fields(module, shared.name).is_some()) {
            wrong.push(format!("no kernel uses {}", shared.name));
        }
        for (kernel, module) in &modules {
            wrong.extend(differences(shared, kernel, module));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_difference_is_noticed() {
    let module =
        naga::front::wgsl::parse_str("struct AimTarget { center: vec3<f32>, axis: vec3<f32>, radius: f32 }").unwrap();
    let shared = SHARED_STRUCTS.iter().find(|s| s.name == "AimTarget").unwrap();
    assert!(!differences(shared, "made up", &module).is_empty());
}

#[test]
fn doc_lines_agree() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("layout");
    let text: String =
        std::fs::read_dir(folder).unwrap().map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap()).collect();
    for shared in SHARED_STRUCTS {
        let body =
            text.split(&format!("\nstruct {} {{\n", shared.name)).nth(1).and_then(|t| t.split("\n}").next()).unwrap();
        for field in shared.fields {
            let docs: String = field.docs.iter().map(|line| format!("    ///{line}\n")).collect();
            let expected = format!("{docs}    {}: ", field.name);
            assert!(format!("{body}\n").contains(&expected), "{}: no such lines in WGSL:\n{expected}", shared.name);
        }
    }
}

#[test]
fn constants_agree() {
    let mut found = HashMap::new();
    for (_, module) in modules() {
        for (_, constant) in module.constants.iter() {
            if let (Some(name), naga::Expression::Literal(Literal::U32(value))) =
                (&constant.name, &module.global_expressions[constant.init])
            {
                found.insert(name.clone(), *value);
            }
        }
    }
    for &(name, value) in SHARED_CONSTANTS {
        if let Some(&wgsl) = found.get(name) {
            assert_eq!(wgsl, value, "{name}");
        }
    }
    assert!(found.contains_key("LEDGER_ACCOUNTS") && found.contains_key("STACK_SIZE"));
}

#[test]
fn kernels_stay_inside_default_limits() {
    for (kernel, module) in modules() {
        let storage = module.global_variables.iter().filter(|(_, v)| matches!(v.space, AddressSpace::Storage { .. }));
        assert!(storage.count() <= 8, "{kernel} binds more than 8 storage buffers");
        for entry in &module.entry_points {
            assert!(entry.workgroup_size.iter().product::<u32>() <= 256, "{kernel}: workgroup over 256 invocations");
        }
    }
}
