//! Files of recorded queries.

use super::files;
use photinus::profile::queries::{
    Block, BlockKey, MapKind, NO_PARENT, QueryFile, QueryFileWriter, QuerySink, RayAnswer, RayHit, RayKind, RayRecord,
    SearchAnswer, SearchKernel, SearchRecord, Stage,
};

/// Opens the file and reads every block.
pub fn run(data: &[u8]) {
    let path = files::put("a.queries", data);
    let Ok(mut file) = QueryFile::open(path) else { return };
    let keys: Vec<BlockKey> = file.keys().collect();
    assert!(keys.is_sorted(), "blocks come in order");
    for (i, key) in keys.iter().enumerate() {
        if let Ok(block) = file.read(i) {
            assert_eq!(block.key, *key);
        }
    }
}

/// A file without blocks and one with every kind of record.
pub fn seeds() -> Vec<Vec<u8>> {
    let hit = RayHit { t: 2.5, alpha: 0.25, beta: 0.5, prim: 7 };
    let ray = |(i, answer): (usize, RayAnswer)| RayRecord {
        kind: RayKind::ALL[i % RayKind::ALL.len()],
        parent: if i == 0 { NO_PARENT } else { i as u32 - 1 },
        origin: [0.0, 1.0, 2.0],
        dir: [0.5, 1e30, -1.0],
        interval: [1e-3, f32::INFINITY],
        answer,
    };
    let answers =
        [RayAnswer::Closest(None), RayAnswer::Closest(Some(hit)), RayAnswer::Any(false), RayAnswer::Any(true)];
    let found =
        [SearchAnswer::Sum([1.0, 2.0, 3.0]), SearchAnswer::Visited, SearchAnswer::Nearest { k: 5, farthest_sq: 0.1 }];
    let search = |(i, answer): (usize, SearchAnswer)| SearchRecord {
        map: if i == 0 { MapKind::Caustic } else { MapKind::Global },
        kernel: if i == 0 { SearchKernel::Constant } else { SearchKernel::Epanechnikov },
        parent: i as u32,
        position: [1.0, 2.0, 3.0],
        radius: 0.75,
        normal: [0.0, 1.0, 0.0],
        max_depth: 127,
        found: 9,
        answer,
    };
    let block = |pass, stage, index| Block {
        key: BlockKey { pass, stage, index },
        rays: answers.into_iter().enumerate().map(ray).collect(),
        searches: found.into_iter().enumerate().map(search).collect(),
        photons: vec![[1, 2, 3, 4, 5, u32::MAX]; 2],
    };
    let file = |blocks: &[Block]| {
        let writer = QueryFileWriter::new(Vec::new(), 1, 100, 2).expect("memory takes all");
        blocks.iter().for_each(|block| writer.record(block));
        writer.finish().expect("memory takes all").0
    };
    vec![
        file(&[]),
        file(&[block(0, Stage::PhotonPass, 0)]),
        file(&[block(1, Stage::EyePass, 3), block(0, Stage::Map, 1), block(0, Stage::PhotonPass, 2)]),
    ]
}
