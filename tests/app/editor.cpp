#include "app/studio/editor.h"

#include <doctest/doctest.h>

using namespace ilf;
using app::Editor;
using When = ui::EditRequest::When;

namespace {

Editor editorWithRegion() {
    Scene scene;
    scene.picture = Box(Picture({200, 100}, 3, std::vector<std::uint16_t>(60000)));
    Editor editor(newDocument(scene));
    Region region;
    region.id = "a";
    region.name = "Face";
    REQUIRE(editor.handle({When::commit, AddRegion{region, 0}}));
    return editor;
}

Paint dab(double x) { return {"a", {Dab{{x, 50.0}, Brush{10.0, 1.0, 1.0}}}, PaintMode::add, false}; }

}  // namespace

TEST_CASE("editor: the dabs of one gesture are one undo step") {
    Editor editor = editorWithRegion();
    const Document before = editor.document();
    for (double x : {40.0, 60.0, 80.0})
        REQUIRE(editor.handle({When::preview, dab(x)}));
    CHECK(editor.previewing());
    editor.commitGesture("Paint");
    const Document after = editor.document();
    CHECK(after != before);
    editor.undo();
    CHECK(editor.document() == before);
    editor.redo();
    CHECK(editor.document() == after);
}

TEST_CASE("editor: a cancelled gesture leaves nothing, not even an undo step") {
    Editor editor = editorWithRegion();
    const Document before = editor.document();
    const auto steps = editor.history().steps();
    REQUIRE(editor.handle({When::preview, dab(40.0)}));
    editor.cancelGesture();
    CHECK(editor.document() == before);
    CHECK(editor.history().steps() == steps);
}

TEST_CASE("editor: a refusal in the middle of a gesture keeps what was painted so far") {
    Editor editor = editorWithRegion();
    REQUIRE(editor.handle({When::preview, dab(40.0)}));
    const Document shown = editor.document();
    const auto refused = editor.handle({When::preview, SetLook{"nobody", Look::blur}});
    CHECK_FALSE(refused);
    CHECK(editor.document() == shown);
}

TEST_CASE("editor: every change of what is shown has a serial of its own") {
    Editor editor = editorWithRegion();
    auto last = editor.serial();
    const auto grew = [&] { return std::exchange(last, editor.serial()) < editor.serial(); };
    REQUIRE(editor.handle({When::commit, dab(40.0)}));
    CHECK(grew());
    editor.undo();
    CHECK(grew());
    editor.redo();
    CHECK(grew());
    editor.goTo(0);
    CHECK(grew());
}
