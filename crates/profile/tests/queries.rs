//! Files of recorded queries: what is written is read, in order, and what is damaged is refused.

use photinus_profile::queries::{
    Block, BlockKey, MapKind, NO_PARENT, QueryFile, QueryFileError, QueryFileWriter, QuerySink, RayAnswer, RayHit,
    RayKind, RayRecord, SearchAnswer, SearchKernel, SearchRecord, Stage,
};

fn key(pass: u32, stage: Stage, index: u32) -> BlockKey {
    BlockKey { pass, stage, index }
}

/// A block with every kind of record.
fn block(key: BlockKey) -> Block {
    let hit = RayHit { t: 2.5, alpha: 0.25, beta: 0.5, prim: 77 };
    let answers =
        [RayAnswer::Closest(None), RayAnswer::Closest(Some(hit)), RayAnswer::Any(false), RayAnswer::Any(true)];
    let rays = RayKind::ALL.iter().flat_map(|kind| answers.map(|answer| (*kind, answer))).enumerate();
    let rays = rays.map(|(i, (kind, answer))| RayRecord {
        kind,
        parent: if i % 3 == 0 { NO_PARENT } else { i as u32 - 1 },
        origin: [i as f32, -0.0, f32::MIN_POSITIVE],
        dir: [0.5, 1e30, -1.0],
        interval: [1e-3, f32::INFINITY],
        answer,
    });
    let answers = [
        SearchAnswer::Sum([1.0, 2.0, 3.0]),
        SearchAnswer::Visited,
        SearchAnswer::Nearest { k: 50, farthest_sq: 0.125 },
    ];
    let searches = [(MapKind::Global, SearchKernel::Constant), (MapKind::Caustic, SearchKernel::Epanechnikov)];
    let searches = searches.iter().flat_map(|kind| answers.map(|answer| (*kind, answer))).enumerate();
    let searches = searches.map(|(i, ((map, kernel), answer))| SearchRecord {
        map,
        kernel,
        parent: i as u32,
        position: [1.0, 2.0, i as f32],
        radius: 0.75,
        normal: [0.0, 1.0, 0.0],
        max_depth: 127,
        found: 9 * i as u32,
        answer,
    });
    Block { key, rays: rays.collect(), searches: searches.collect(), photons: vec![[1, 2, 3, 4, 5, u32::MAX]; 3] }
}

fn file(blocks: &[Block]) -> Vec<u8> {
    let writer = QueryFileWriter::new(Vec::new(), 0x0123_4567_89AB_CDEF, 100, 2).unwrap();
    blocks.iter().for_each(|block| writer.record(block));
    let (bytes, totals) = writer.finish().unwrap();
    assert_eq!(totals.bytes, bytes.len() as u64);
    assert_eq!(totals.rays, blocks.iter().map(|block| block.rays.len() as u64).sum());
    bytes
}

fn open(bytes: &[u8]) -> Result<QueryFile, QueryFileError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    QueryFile::open(file.path())
}

#[test]
fn what_is_written_is_read_in_the_order_of_the_render() {
    let in_order = [
        block(key(0, Stage::PhotonPass, 0)),
        Block::new(key(0, Stage::Map, 1)),
        block(key(0, Stage::EyePass, 3)),
        block(key(1, Stage::PhotonPass, 1 << 31)),
    ];
    let mut shuffled = in_order.clone();
    shuffled.reverse();
    shuffled.swap(0, 1);
    let mut read = open(&file(&shuffled)).unwrap();
    assert_eq!(read.scene_hash(), 0x0123_4567_89AB_CDEF);
    assert_eq!(read.primitives(), (100, 2));
    assert_eq!(read.keys().collect::<Vec<_>>(), in_order.iter().map(|block| block.key).collect::<Vec<_>>());
    for (i, block) in in_order.iter().enumerate() {
        assert_eq!(read.read(i).unwrap(), *block);
    }
}

/// The documented lengths, so that files can be read by programs that know only docs/queries.md.
#[test]
fn records_are_as_long_as_documented() {
    let empty = file(&[]).len();
    assert_eq!(empty, 32);
    let whole = block(key(0, Stage::EyePass, 0));
    let (rays, searches, photons) = (whole.rays.len(), whole.searches.len(), whole.photons.len());
    assert_eq!(file(&[whole]).len(), 32 + 24 + 56 * rays + 60 * searches + 24 * photons);
}

#[test]
fn what_is_cut_or_damaged_is_refused() {
    let bytes = file(&[block(key(0, Stage::PhotonPass, 0)), block(key(0, Stage::EyePass, 0))]);
    let second = 32 + (bytes.len() - 32) / 2;
    for length in 0..bytes.len() {
        let at_an_end = length == 32 || length == second;
        assert_eq!(open(&bytes[..length]).is_ok(), at_an_end, "cut to {length} bytes");
    }
    let damaged = |at: usize, value: u8| -> Result<(), QueryFileError> {
        let mut bytes = bytes.clone();
        bytes[at] = value;
        let mut file = open(&bytes)?;
        (0..file.block_count()).try_for_each(|i| file.read(i).map(drop))
    };
    assert!(damaged(64, 1).is_ok(), "a coordinate may be anything");
    let rays = 4 * RayKind::ALL.len();
    for (at, value, what) in [
        (0, b'X', "magic"),
        (32 + 4, 9, "stage"),
        (32 + 15, 255, "more rays than the file is long"),
        (32 + 24, 99, "kind of ray"),
        (32 + 25, 9, "answer of a ray"),
        (32 + 24 + 56 + 4, 200, "a parent that comes later"),
        (32 + 24 + 56 * rays, 7, "map"),
        (32 + 24 + 56 * rays + 1, 7, "kernel"),
        (32 + 24 + 56 * rays + 2, 7, "answer of a search"),
        (32 + 24 + 56 * rays + 4, 200, "a search's parent that is none"),
    ] {
        assert!(damaged(at, value).is_err(), "{what}");
    }
}

/// A disk that is full after so many bytes.
struct Full(usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(std::io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_at_the_end_and_no_panic() {
    let whole = block(key(0, Stage::EyePass, 0));
    let writer = QueryFileWriter::new(Full(2000), 0, 0, 0).unwrap();
    writer.record(&whole);
    writer.record(&whole);
    assert!(writer.finish().is_err());
}
