// Undo and redo: an index into a list of documents, trimmed by bytes.
#include "core/document/history.h"

#include "scenes.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

/// Commits `edit`, if it is not refused.
bool commit(History& history, const Edit& edit) {
    auto next = edited(history.current(), edit);
    if (!next) return false;
    history.preview(*std::move(next));
    history.commit(label(edit));
    return true;
}

Edit dabAt(double x) { return Paint{"a", {{{x, 100.0}, {10.0, 0.5, 1.0}}}}; }

}  // namespace

TEST_CASE("history: undo gives the document before, redo the one after, over any edits") {
    law("any sequence of edits", [] {
        History history(twoRegions());
        std::vector<Document> documents{history.current()};
        const int edits = *rc::gen::inRange(1, 12);
        for (int i = 0; i < edits; ++i) {
            const std::size_t before = history.steps();
            if (commit(history, anyEdit()) && history.steps() > before) documents.push_back(history.current());
        }
        RC_ASSERT(history.steps() == documents.size());
        for (std::size_t i = documents.size() - 1; i > 0; --i) {
            history.undo();
            RC_ASSERT(history.current() == documents[i - 1]);
            history.redo();
            RC_ASSERT(history.current() == documents[i]);
            history.undo();
        }
        RC_ASSERT(!history.canUndo());
    });
}

TEST_CASE("history: a gesture is one step, and one that is cancelled leaves nothing") {
    History history(twoRegions());
    const Document first = history.current();
    for (double x = 20.0; x < 200.0; x += 10.0)
        history.preview(*edited(history.current(), dabAt(x)));
    const Document painted = history.current();
    history.commit("Paint");
    CHECK(history.steps() == 2);
    CHECK(history.undoLabel() == "Paint");
    CHECK(history.revision() == 1);

    history.preview(first);
    CHECK(history.current() == first);
    history.cancel();
    CHECK(history.current() == painted);

    history.preview(*edited(painted, dabAt(300.0)));
    history.undo();  // the gesture first
    CHECK(history.current() == painted);
    history.undo();
    CHECK(history.current() == first);
    CHECK(history.redoLabel() == "Paint");
    CHECK(history.undoLabel().empty());
    CHECK(history.revision() == 2);
}

TEST_CASE("history: a commit that changes nothing is no step, and one after an undo drops what was undone") {
    History history(twoRegions());
    history.preview(history.current());
    history.commit("Nothing");
    CHECK(history.steps() == 1);
    history.commit("Still nothing");
    CHECK(history.steps() == 1);

    commit(history, dabAt(50.0));
    commit(history, dabAt(150.0));
    history.undo();
    CHECK(history.canRedo());
    commit(history, SetAlpha{0.3_D});
    CHECK_FALSE(history.canRedo());
    CHECK(history.steps() == 3);
    CHECK(history.labelAt(2) == "Set alpha");
    history.redo();
    CHECK(history.position() == 2);
}

TEST_CASE("history: the oldest steps go when their bytes are too many, never what is shown") {
    // A dab inside one tile keeps that tile alive and its mask's list of 20 boxes.
    History history(twoRegions(), 5 * (sizeof(Tile) + 20 * sizeof(Box<Tile>)) + 100);
    for (int i = 0; i < 40; ++i)
        commit(history, Paint{"a", {{{25.0 + 0.5 * i, 25.0}, {5.0, 0.5, 1.0}}}});
    CHECK(history.steps() == 6);
    CHECK(history.position() == 5);
    const Document last = history.current();
    for (int i = 0; i < 5; ++i)
        history.undo();
    CHECK_FALSE(history.canUndo());
    for (int i = 0; i < 5; ++i)
        history.redo();
    CHECK(history.current() == last);

    History tiny(twoRegions(), 0);
    commit(tiny, dabAt(50.0));
    CHECK(tiny.steps() == 1);
    CHECK(tiny.current() == *edited(twoRegions(), dabAt(50.0)));
}

TEST_CASE("history: what neighbouring steps share is counted once") {
    // A picture of 40 x 30 is 7200 bytes; only the two steps that change it count.
    History history(twoRegions(), 3 * 7200);
    for (int i = 0; i < 200; ++i)
        commit(history, RenameRegion{"a", "Face " + std::to_string(i)});
    CHECK(history.steps() > 10);
}

}  // namespace ilf
