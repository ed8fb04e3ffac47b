use glam::UVec2;

use super::*;
use crate::app::snapshots::thumbnail::Thumbnail;
use crate::image::exr::{read_picture, read_snapshot};

fn film() -> Film {
    let mut film = Film::new(UVec2::new(2, 1)).unwrap();
    film.add(UVec2::ZERO, &Default::default());
    film
}

fn record(name: &str, kept: u64) -> Record {
    Record { name: name.to_owned(), kept, spp: 0.5, ..Record::default() }
}

fn add(store: &Store, record: Record) -> StoredSnapshot {
    let thumbnail = Thumbnail { size: UVec2::ONE, pixels: vec![[0.5; 4]] };
    let (film, header) = (film(), SnapshotHeader::default());
    let tone = Tone::default();
    store.add(Fresh { film: &film, header: &header, record, thumbnail: &thumbnail, tone }).unwrap()
}

fn names(store: &Store) -> Vec<String> {
    store.list().entries.into_iter().map(|entry| entry.record.name).collect()
}

#[test]
fn snapshots_are_there_again_in_the_order_they_were_kept() {
    let data = tempfile::tempdir().unwrap();
    let store = Store::new(&data.path().join("not/made/yet"));
    assert_eq!(store.list(), Listing::default());
    let second = add(&store, record("second", 2000));
    let first = add(&store, Record { noise: Some(0.25), ..record("first", 1000) });
    let third = add(&store, record("third", 2000));
    assert_ne!(second.id, third.id, "two of one moment have places of their own");
    assert_eq!(
        store.list(),
        Listing { entries: vec![first, second.clone(), third], ..store.list() }
    );
    assert!(store.list().problems.is_empty());
    assert_eq!(read_snapshot(&store.picture(&second.id)).unwrap().film, film());
    assert_eq!(read_picture(&store.picture(&second.id)).unwrap().0, UVec2::new(2, 1));
    assert_eq!(
        crate::app::snapshots::thumbnail::read(&store.thumbnail(&second.id)).unwrap().size,
        [1, 1]
    );
    assert!(second.bytes > 500);
    assert_eq!(fs::read_dir(&store.deleted).unwrap().count(), 0, "something is left behind");

    store.describe(&second.id, &Record { note: "so far".to_owned(), ..second.record }).unwrap();
    assert_eq!(store.list().entries[1].record.note, "so far");
    assert_eq!(store.id_of(&store.picture(&second.id)), Some(second.id.clone()));
    assert_eq!(store.id_of(&store.thumbnail(&second.id)), None);
    assert_eq!(store.id_of(Path::new("/elsewhere/1/picture.exr")), None);
}

#[test]
fn deleted_snapshots_come_back_until_they_are_forgotten() {
    let data = tempfile::tempdir().unwrap();
    let store = Store::new(data.path());
    let [a, b] = [1, 2].map(|kept| add(&store, record("x", kept)).id);
    store.delete(&a).unwrap();
    assert_eq!(names(&store).len(), 1);
    store.restore(&a).unwrap();
    assert_eq!(names(&store).len(), 2);
    store.delete(&a).unwrap();
    store.clean(Duration::from_secs(3600));
    store.delete(&b).unwrap();
    store.forget(std::slice::from_ref(&a));
    assert!(store.restore(&a).unwrap_err().to_string().contains(&a));
    store.restore(&b).unwrap();
    store.delete(&b).unwrap();
    store.clean(Duration::ZERO);
    assert!(store.restore(&b).is_err() && names(&store).is_empty());
    assert!(store.delete("nothing").is_err());
}

#[test]
fn what_is_broken_is_skipped_and_told() {
    let data = tempfile::tempdir().unwrap();
    let store = Store::new(data.path());
    add(&store, record("sound", 1));
    let put = |name: &str, text: &[u8]| {
        let path = data.path().join("snapshots").join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    put("holiday.jpg", b"x");
    put(".DS_Store", b"x");
    put("half/snapshot.toml", b"name = \"half\"\nkept = ");
    put("foreign/other.txt", b"x");
    put("huge/snapshot.toml", &[b' '; 100_000]);
    put("pictureless/snapshot.toml", toml::to_string(&record("x", 9)).unwrap().as_bytes());
    put("bytes/snapshot.toml", &[0xff, 0xfe, 0]);
    assert_eq!(names(&store), ["sound"]);
    let problems = store.list().problems;
    let of = ["bytes", "foreign", "half", "holiday.jpg", "huge", "pictureless"];
    assert_eq!(problems.len(), of.len());
    for (problem, name) in std::iter::zip(&problems, of) {
        assert!(problem.contains(name), "{problem}");
    }
}

#[test]
fn the_oldest_without_a_note_go_first_and_the_newest_never() {
    let entry = |id: u64, note: &str| StoredSnapshot {
        id: id.to_string(),
        record: Record { note: note.to_owned(), ..record("x", id) },
        bytes: 10,
    };
    let entries = [entry(1, "good"), entry(2, ""), entry(3, ""), entry(4, "")];
    let gone = |limit| -> Vec<String> {
        victims(&entries, limit, "4").into_iter().map(|entry| entry.id).collect()
    };
    assert!(gone(40).is_empty());
    assert_eq!(gone(39), ["2"]);
    assert_eq!(gone(20), ["2", "3"]);
    assert_eq!(gone(0), ["2", "3", "1"]);
}

#[test]
fn a_new_snapshot_makes_room_for_itself() {
    let data = tempfile::tempdir().unwrap();
    let store = Store::new(data.path());
    let bytes = add(&store, record("a", 1)).bytes;
    add(&store, record("b", 2));
    let newest = add(&store, record("c", 3)).id;
    let gone = store.make_room(2 * bytes + bytes / 2, &newest);
    assert_eq!(gone.iter().map(|entry| entry.record.name.as_str()).collect::<Vec<_>>(), ["a"]);
    assert_eq!(names(&store), ["b", "c"]);
}
