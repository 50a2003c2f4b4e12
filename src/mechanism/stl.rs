//! Triangles from an STL file, text or binary.

/// Corners and the triangles between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Triangles {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// Reads either form; the error is a phrase for the user.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, String> {
    // Some binary files open with "solid" too, so the length decides.
    match binary_count(bytes) {
        Some(count) if bytes.len() >= 84 + 50 * count && count > 0 => Ok(from_binary(bytes, count)),
        _ => text(bytes),
    }
}

fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count: [u8; 4] = bytes.get(80..84)?.try_into().ok()?;
    Some(u32::from_le_bytes(count) as usize)
}

fn from_binary(bytes: &[u8], count: usize) -> Triangles {
    let mut mesh = Triangles::default();
    for facet in bytes[84..84 + 50 * count].chunks_exact(50) {
        // 12 bytes of normal come first, 2 of attributes last.
        let corners = facet[12..48].chunks_exact(12).map(|corner| {
            let number = |k: usize| {
                let b = &corner[4 * k..4 * k + 4];
                f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            };
            [number(0), number(1), number(2)]
        });
        mesh.push(corners);
    }
    mesh
}

fn text(bytes: &[u8]) -> Result<Triangles, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "neither text nor binary STL".to_owned())?;
    let mut corners = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
        let corner: [f64; 3] = numbers.try_into().map_err(|_| format!("`{}` is no vertex", line.trim()))?;
        corners.push(corner);
    }
    if corners.is_empty() || corners.len() % 3 != 0 {
        return Err(format!("{} vertices make no whole triangles", corners.len()));
    }
    let mut mesh = Triangles::default();
    for facet in corners.chunks_exact(3) {
        mesh.push(facet.iter().copied());
    }
    Ok(mesh)
}

/// Triangles as a binary file; normals are left to the reader.
pub(super) fn binary(mesh: &Triangles) -> Vec<u8> {
    let mut bytes = vec![0u8; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0u8; 12]);
        let corners = triangle.iter().flat_map(|&i| mesh.vertices[i as usize]);
        bytes.extend(corners.flat_map(|x| (x as f32).to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    bytes
}

impl Triangles {
    pub(super) fn push(&mut self, corners: impl Iterator<Item = [f64; 3]>) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners);
        self.triangles.push([first, first + 1, first + 2]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
                        vertex 0 1 0.5\nendloop\nendfacet\nendsolid s\n";

    #[test]
    fn text_and_binary_agree() {
        let mut bytes = vec![0u8; 80];
        bytes.extend(1u32.to_le_bytes());
        bytes.extend([0u8; 12]);
        for v in [0f32, 0., 0., 1., 0., 0., 0., 1., 0.5] {
            bytes.extend(v.to_le_bytes());
        }
        bytes.extend([0u8; 2]);
        assert_eq!(read(&bytes), read(TEXT.as_bytes()));
        assert_eq!(read(TEXT.as_bytes()).map(|m| m.triangles.len()), Ok(1));
        assert_eq!(read(TEXT.as_bytes()).map(|m| binary(&m)), Ok(bytes));
    }

    #[test]
    fn rubbish_is_refused() {
        assert!(read(b"").is_err());
        assert!(read(&[255; 100]).is_err());
        assert!(read(b"vertex 1 2\n").is_err());
    }
}
