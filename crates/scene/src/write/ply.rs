//! Binary little-endian PLY.

use crate::Mesh;

/// The bytes of a mesh: positions, then what it has of normals, texture coordinates and colours, then triangles.
pub fn encode(mesh: &Mesh) -> Vec<u8> {
    let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    let mut properties = vec!["x", "y", "z"];
    let (normals, uvs, colors) = (!mesh.normals.is_empty(), !mesh.uvs.is_empty(), !mesh.colors.is_empty());
    for (there, names) in [(normals, &["nx", "ny", "nz"][..]), (uvs, &["u", "v"]), (colors, &["r", "g", "b"])] {
        if there {
            properties.extend(names);
        }
    }
    for name in &properties {
        header += &format!("property float {name}\n");
    }
    header += &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.len());

    let size = header.len() + mesh.positions.len() * properties.len() * 4 + mesh.triangles.len() * 13;
    let mut bytes = Vec::with_capacity(size);
    bytes.extend(header.as_bytes());
    let mut put = |values: &[f32]| values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    for i in 0..mesh.positions.len() {
        put(&mesh.positions[i].to_array());
        if normals {
            put(&mesh.normals[i].to_array());
        }
        if uvs {
            put(&mesh.uvs[i].to_array());
        }
        if colors {
            put(&mesh.colors[i].to_array());
        }
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        triangle.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    bytes
}
