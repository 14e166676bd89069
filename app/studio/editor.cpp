#include "app/studio/editor.h"

namespace ilf::app {

Result<void> Editor::handle(const ui::EditRequest& request) {
    auto next = edited(history_.current(), request.edit);
    if (!next) return tl::unexpected(next.error());
    history_.preview(*std::move(next));
    previewing_ = true;
    ++serial_;
    if (request.when == ui::EditRequest::When::commit) commitGesture(label(request.edit));
    return {};
}

void Editor::commitGesture(const std::string& label) {
    history_.commit(label);
    previewing_ = false;
}

void Editor::cancelGesture() {
    if (!previewing_) return;
    history_.cancel();
    previewing_ = false;
    ++serial_;
}

void Editor::undo() {
    if (!previewing_ && !history_.canUndo()) return;
    history_.undo();
    previewing_ = false;
    ++serial_;
}

void Editor::redo() {
    if (!history_.canRedo()) return;
    history_.redo();
    previewing_ = false;
    ++serial_;
}

void Editor::goTo(std::size_t step) {
    while (history_.position() > step && history_.canUndo())
        undo();
    while (history_.position() < step && history_.canRedo())
        redo();
}

void Editor::replace(Document document) {
    history_ = History(std::move(document));
    previewing_ = false;
    ++serial_;
}

}  // namespace ilf::app
