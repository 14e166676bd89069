// The editor: folds gestures onto the history, one undo step a gesture.
#pragma once

#include <cstdint>

#include "core/document/history.h"
#include "ui/request.h"

namespace ilf::app {

/// Owns the history. `serial` counts every change of what is shown, so that late results can be told from current ones.
class Editor {
public:
    explicit Editor(Document first) : history_(std::move(first)) {}

    const Document& document() const { return history_.current(); }
    const History& history() const { return history_; }
    std::uint64_t serial() const { return serial_; }
    bool previewing() const { return previewing_; }

    /// Folds an edit onto what is shown; a commit closes the undo step. A refusal leaves all as it was.
    Result<void> handle(const ui::EditRequest& request);
    /// The previews since the last commit become one step.
    void commitGesture(const std::string& label);
    void cancelGesture();
    void undo();
    void redo();
    void goTo(std::size_t step);
    /// Another document altogether (open, new, recover): the history begins anew.
    void replace(Document document);

private:
    History history_;
    std::uint64_t serial_ = 1;
    bool previewing_ = false;
};

}  // namespace ilf::app
