use super::*;

fn entry(name: &str) -> StoredSnapshot {
    let record = Record { name: name.to_owned(), ..Record::default() };
    StoredSnapshot { id: format!("id of {name}"), record, bytes: 10 }
}

fn strip(names: &[&str]) -> Strip {
    let mut strip = Strip::default();
    strip.fill(names.iter().map(|name| (entry(name), None)).collect());
    strip
}

fn shown(strip: &Strip) -> &str {
    strip.shown_item().map_or("live", |item| &item.record.name)
}

fn names(strip: &Strip) -> Vec<&str> {
    strip.items().iter().map(|item| item.record.name.as_str()).collect()
}

fn picture(pixels: usize) -> Arc<Picture> {
    Arc::new(Picture {
        size: glam::UVec2::ONE,
        pixels: vec![[0.0; 4]; pixels],
        complete: true,
        ..Picture::default()
    })
}

#[test]
fn flipping_ends_at_the_oldest_and_at_the_live_picture() {
    let mut strip = strip(&["a", "b"]);
    assert_eq!(shown(&strip), "live");
    let mut seen = Vec::new();
    for _ in 0..3 {
        strip.show_previous();
        seen.push(shown(&strip).to_owned());
    }
    for _ in 0..3 {
        strip.show_next();
        seen.push(shown(&strip).to_owned());
    }
    assert_eq!(seen, ["b", "a", "a", "b", "live", "live"]);
    let mut empty = Strip::default();
    empty.show_previous();
    empty.show_next();
    assert!(shown(&empty) == "live" && empty.delete().is_none() && !empty.is_open());
}

#[test]
fn deleted_snapshots_come_back_to_their_places() {
    let mut strip = strip(&["a", "b", "c"]);
    strip.show(Some(0));
    assert!(matches!(strip.delete(), Some(DiskJob::Delete(id)) if id == "id of a"));
    assert_eq!(shown(&strip), "b");
    strip.show(Some(1));
    strip.delete();
    assert_eq!((shown(&strip), names(&strip)), ("live", vec!["b"]));
    assert_eq!(strip.last_deleted(), Some("c"));
    assert!(matches!(strip.undo_delete(), Some(DiskJob::Restore(id)) if id == "id of c"));
    assert_eq!(shown(&strip), "c");
    strip.undo_delete();
    assert_eq!((shown(&strip), names(&strip)), ("a", vec!["a", "b", "c"]));
    assert!(strip.undo_delete().is_none());
    strip.delete();
    assert!(matches!(strip.forget_deleted(), Some(DiskJob::Forget(ids)) if ids == ["id of a"]));
    assert!(strip.undo_delete().is_none() && strip.forget_deleted().is_none());
}

#[test]
fn names_and_notes_are_cleaned_and_written_once() {
    let mut strip = strip(&["a", "b"]);
    assert!(strip.edited().is_empty());
    strip.show(Some(1));
    let record = &mut strip.shown_item_mut().unwrap().record;
    record.name = format!("  x\ny{} ", "z".repeat(500));
    record.note = "good".to_owned();
    let jobs = strip.edited();
    let [DiskJob::Describe(id, record)] = &jobs[..] else { panic!("one job") };
    assert_eq!((id.as_str(), record.note.as_str()), ("id of b", "good"));
    assert!(record.name.starts_with("x yz") && record.name.chars().count() == LONGEST_NAME);
    assert!(strip.edited().is_empty());
    strip.shown_item_mut().unwrap().record.name = " ".to_owned();
    assert!(strip.edited().is_empty(), "a snapshot keeps a name");
    assert!(shown(&strip).starts_with("x yz"));
    assert_eq!([strip.free_name("a"), strip.free_name("c")], ["a 2", "c"]);
}

#[test]
fn the_picture_shown_is_read_first_and_then_its_neighbors() {
    let mut strip = strip(&["a", "b", "c", "d"]);
    let wanted = |strip: &Strip| match strip.wanted() {
        Some(DiskJob::Read(entry)) => entry.record.name,
        _ => String::new(),
    };
    assert_eq!(wanted(&strip), "", "the live picture needs none");
    strip.show(Some(2));
    assert_eq!(wanted(&strip), "c");
    assert!(strip.take_in("id of c", Some(picture(1))));
    assert_eq!(wanted(&strip), "b");
    assert!(!strip.take_in("id of b", None));
    assert_eq!(wanted(&strip), "d", "what cannot be read is not tried again");
    strip.take_in("id of d", Some(picture(1)));
    assert_eq!(wanted(&strip), "");
}

#[test]
fn far_pictures_are_let_go_of_when_memory_runs_short() {
    let mut strip = strip(&["a", "b", "c"]);
    let half = READY_BYTES / 32;
    for id in ["id of a", "id of b", "id of c"] {
        strip.show(Some(2));
        strip.take_in(id, Some(picture(half + 1)));
    }
    let ready: Vec<bool> = strip.items().iter().map(|item| item.picture.is_some()).collect();
    assert_eq!(ready, [false, true, true]);
}

#[test]
fn what_went_from_the_disk_goes_from_the_strip() {
    let mut strip = strip(&["a", "b", "c"]);
    strip.show(Some(2));
    strip.remove(&[entry("a")]);
    assert_eq!((shown(&strip), names(&strip)), ("c", vec!["b", "c"]));
    strip.remove(&[entry("c")]);
    assert_eq!((shown(&strip), strip.bytes()), ("live", 10));
}
