//! Small files of every format, made here, and a folder that holds them for scenes that name them.

use std::io::Write;
use std::path::PathBuf;

/// One triangle with all that OBJ files may hold beside it.
pub const OBJ: &str = "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1e0 1\nvt 0 0\nvt 1 0.5 0\nvn 0 0 1\n\
     vn 1 2 3\no a b\ng c\nusemtl m0\ns 1\nf 1/1/1 2/2/1 3//2 \\\n 4\ns off\nf -1 -2 -3\nusemtl m1\n\
     f 1 2 5 3 4\nf 2//1 3//1 5//1\n# end\n";

/// Materials of most kinds.
pub const MTL: &str = "newmtl m0\nKd 1 .5 0\nKs .1 .1 .1\nNs 10\nKe 1 1 1\nmap_Kd -o 1 2 -s 3 -clamp on a.png\nd 0.5\nTr 0.5\n\
     illum 2\nbump -bm 0.5 a.png\nmap_d -imfchan m a.png\nnewmtl m1\nillum 7\nTf 1 1 1\nNi 1.5\nnewmtl m2\nPr 0.5\nPm 1\n\
     Pc 1\naniso .5\nnorm a.png\nmap_Pr a.exr\nnewmtl m3\nillum 3\nKs 1 1 1\nKd xyz 1 1 1\nmap_Ke -mm 0 2 a.hdr\n";

/// Wavelengths in nm and values.
pub const SPECTRUM: &str = "# grey\n360 0.25\n500 0.5 # green\n\n830 0.25\n";

/// An STL file of text.
pub const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
     endsolid a\nsolid b\nendsolid b\n";

/// A PLY file of text with every element that is known.
pub fn ply_text() -> String {
    ply_header("ascii")
        + "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n6 0 1 2 3 -1 0\n"
}

/// The same in bytes; `big` says which end of a number comes first.
pub fn ply_binary(big: bool) -> Vec<u8> {
    let mut bytes = ply_header(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    let float = |x: f32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
    let int = |x: i32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
    for p in [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        bytes.extend(p.iter().flat_map(|x| float(*x)).chain([1, 2, 3]));
    }
    bytes.push(4);
    bytes.extend([0i32, 1, 2, 3].iter().flat_map(|x| int(*x)));
    bytes.push(8);
    bytes.extend([0f32; 8].iter().flat_map(|x| float(*x)));
    bytes.extend([5i32, 0, 1, 2, -1, 3].iter().flat_map(|x| int(*x)));
    bytes
}

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float \
         z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int \
         vertex_indices\nproperty list uchar float texcoord\nelement tristrips 1\nproperty list int int \
         vertex_indices\nend_header\n"
    )
}

/// A binary STL file of two facets.
pub fn stl_binary() -> Vec<u8> {
    let mut bytes = vec![b'x'; 80];
    bytes.extend(2u32.to_le_bytes());
    for facet in [[0f32, 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.], [0., 0., 1., 1., 0., 0., 1., 1., 0., 0., 1., 0.]]
    {
        bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()).chain([0, 0]));
    }
    bytes
}

/// `bytes` as a gzip file.
pub fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(bytes).expect("memory takes all");
    gzip.finish().expect("memory takes all")
}

/// What a serialized mesh holds before it is compressed: one triangle with all attributes that `flags` names.
pub fn serialized_content(version: u8, flags: u32) -> Vec<u8> {
    let mut out = flags.to_le_bytes().to_vec();
    if version == 4 {
        out.extend(b"name\0");
    }
    out.extend(3u64.to_le_bytes());
    out.extend(1u64.to_le_bytes());
    let numbers =
        9 + 9 * usize::from(flags & 1 != 0) + 6 * usize::from(flags & 2 != 0) + 9 * usize::from(flags & 8 != 0);
    for i in 0..numbers {
        let x = ((i * 7 + 3) % 5) as f32;
        if flags & 0x2000 != 0 { out.extend(f64::from(x).to_le_bytes()) } else { out.extend(x.to_le_bytes()) }
    }
    out.extend([0u32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
    out
}

/// A serialized file of one mesh with this content.
pub fn serialized(version: u8, content: &[u8]) -> Vec<u8> {
    let mut zlib = flate2::write::ZlibEncoder::new(vec![0x1c, 0x04, version, 0], flate2::Compression::fast());
    zlib.write_all(content).expect("memory takes all");
    let mut file = zlib.finish().expect("memory takes all");
    file.extend(if version == 4 { &[0; 8][..] } else { &[0; 4][..] });
    file.extend(1u32.to_le_bytes());
    file
}

thread_local! {
    /// The folder of this thread.
    static FOLDER: Folder = Folder::new();
}

/// A folder with a small file of every format, all called `a`.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        // In memory where there is such a place: a fuzzer writes thousands of files a second.
        let memory = std::path::Path::new("/dev/shm");
        let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        let folder = Self(folder.expect("a temporary folder"));
        let first = |images: Vec<Vec<u8>>| images.into_iter().next().expect("a seed");
        let part = "<scene version='3.0.0'><bsdf type='diffuse' id='part'/><shape type='cube'/></scene>";
        let circle = "<scene version='3.0.0'><include filename='circle.xml'/></scene>";
        for (name, content) in [
            ("a.obj", OBJ.as_bytes().to_vec()),
            ("a.mtl", MTL.as_bytes().to_vec()),
            ("a.ply", ply_text().into_bytes()),
            ("a.stl", stl_binary()),
            ("a.serialized", serialized(4, &serialized_content(4, 0x1003))),
            ("a.spd", SPECTRUM.as_bytes().to_vec()),
            ("a.png", first(super::images::png_seeds())),
            ("a.exr", first(super::images::exr_seeds())),
            ("a.hdr", first(super::images::hdr_seeds())),
            ("part.xml", part.as_bytes().to_vec()),
            ("circle.xml", circle.as_bytes().to_vec()),
        ] {
            std::fs::write(folder.0.path().join(name), content).expect("a file of the folder");
        }
        folder
    }
}

/// Writes a file into the folder and returns its path.
pub fn put(name: &str, content: &[u8]) -> PathBuf {
    FOLDER.with(|folder| {
        let path = folder.0.path().join(name);
        std::fs::write(&path, content).expect("a file of the folder");
        path
    })
}
