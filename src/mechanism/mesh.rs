//! Mesh files of a URDF: where they are, and their triangles.

use std::path::{Path, PathBuf};

use super::geometry::Shape;
use super::stl::{self, Triangles};
use crate::stock;

/// Why a mesh cannot be had: what is wrong, and with which file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeshFault {
    pub file: PathBuf,
    pub reason: String,
    pub remedy: &'static str,
}

/// The mesh that `name` in a URDF means, scaled.
pub(super) fn read(urdf: &Path, name: &str, scale: [f64; 3]) -> Result<Shape, MeshFault> {
    let folder = urdf.parent().unwrap_or(Path::new(""));
    let file = find(folder, name);
    let fault = |reason: String, remedy| MeshFault { file: file.clone(), reason, remedy };
    let ending = file.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let convert = "convert it to STL or OBJ";
    if !matches!(ending.as_str(), "stl" | "obj") {
        return Err(fault(format!("*.{ending} meshes are not read"), convert));
    }
    let wanted = "give the file relative to the URDF, or keep the package's folder above the URDF";
    let bytes = stock::read(&file).map_err(|e| fault(e.to_string(), wanted))?;
    let found = if ending == "obj" { obj(&bytes) } else { stl::read(&bytes) };
    let found = found.map_err(|reason| fault(reason, convert))?;
    let scaled = |v: &[f64; 3]| [v[0] * scale[0], v[1] * scale[1], v[2] * scale[2]];
    let vertices_m: Vec<[f64; 3]> = found.vertices.iter().map(scaled).collect();
    // Finite numbers can multiply to one that is not.
    if !vertices_m.iter().flatten().all(|v| v.is_finite()) {
        return Err(fault(
            "a vertex or the scale is not finite".to_owned(),
            "write finite vertices, in m, and a finite scale",
        ));
    }
    Ok(Shape::Mesh { vertices_m, triangles: found.triangles })
}

/// All triangles of a Wavefront file; its materials are not looked at.
fn obj(bytes: &[u8]) -> Result<Triangles, String> {
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let no_materials = |_: &Path| Ok((Vec::new(), Default::default()));
    let (models, _) = tobj::load_obj_buf(&mut &*bytes, &options, no_materials).map_err(|e| e.to_string())?;
    let mut all = Triangles::default();
    for mesh in models.into_iter().map(|m| m.mesh) {
        let offset = all.vertices.len() as u32;
        all.vertices.extend(mesh.positions.as_chunks::<3>().0.iter().map(|v| v.map(f64::from)));
        all.triangles.extend(mesh.indices.as_chunks::<3>().0.iter().map(|t| t.map(|i| i + offset)));
    }
    if all.triangles.is_empty() { Err("it holds no faces".to_owned()) } else { Ok(all) }
}

/// `package://NAME/rest` is looked for as ROS would find it: in a folder NAME at or above the URDF's, in the folders of
/// `ROS_PACKAGE_PATH`, and last below the URDF's folder.
fn find(folder: &Path, name: &str) -> PathBuf {
    let name = name.strip_prefix("file://").unwrap_or(name);
    let Some(packaged) = name.strip_prefix("package://") else { return stock::join(folder, Path::new(name)) };
    let inner = packaged.split_once('/').map_or(packaged, |(_, inner)| inner);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let above = folder.ancestors().map(|up| up.join(packaged));
    let ros = std::env::var_os("ROS_PACKAGE_PATH").unwrap_or_default();
    let ros: Vec<PathBuf> = std::env::split_paths(&ros).map(|path| path.join(packaged)).collect();
    above.chain(ros).find(|path| path.is_file()).unwrap_or_else(|| folder.join(inner))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PYRAMID: &str = "# five corners\no pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n\
        f 1 2 3 4\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

    #[test]
    fn an_obj_file_gives_its_triangles_scaled() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("p.obj"), PYRAMID).expect("written");
        let shape = read(&folder.path().join("r.urdf"), "p.obj", [0.001; 3]).expect("a mesh");
        let Shape::Mesh { vertices_m, triangles } = shape else { panic!("{shape:?}") };
        // The square is cut in two.
        assert_eq!(triangles.len(), 6);
        assert!(vertices_m.iter().flatten().all(|x| (0.0..=0.001 + 1e-12).contains(x)));
    }

    #[test]
    fn a_scale_that_leads_beyond_all_numbers_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("p.obj"), PYRAMID.replace("0.5 1", "0.5 1e30")).expect("written");
        let fault = read(&folder.path().join("r.urdf"), "p.obj", [1.0, 1.0, 1e300]).expect_err("too large");
        assert!(fault.reason.contains("not finite"), "{fault:?}");
    }

    #[test]
    fn a_package_is_found_above_the_urdf() {
        let root = tempfile::tempdir().expect("a folder");
        let meshes = root.path().join("hand_description/meshes");
        let urdf = root.path().join("hand_description/urdf/hand.urdf");
        std::fs::create_dir_all(&meshes).expect("a folder");
        std::fs::create_dir_all(urdf.parent().expect("a parent")).expect("a folder");
        std::fs::write(meshes.join("p.obj"), PYRAMID).expect("written");
        assert!(read(&urdf, "package://hand_description/meshes/p.obj", [1.0; 3]).is_ok());
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        let folder = tempfile::tempdir().expect("a folder");
        let urdf = folder.path().join("r.urdf");
        std::fs::write(folder.path().join("bad.obj"), "f 1 2 9\n").expect("written");
        std::fs::write(folder.path().join("none.obj"), "v 0 0 0\n").expect("written");
        for (name, reason) in [("a.dae", "not read"), ("gone.stl", "No such file"), ("none.obj", "no faces")] {
            let fault = read(&urdf, name, [1.0; 3]).expect_err(name);
            assert!(fault.reason.contains(reason), "{fault:?}");
        }
        assert!(read(&urdf, "bad.obj", [1.0; 3]).is_err());
    }
}
