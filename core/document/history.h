// Undo and redo: a list of documents, trimmed by the bytes that only it keeps alive.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/document/document.h"

namespace ilf {

/// A gesture folds previews onto what is shown; `commit` closes the undo step. `undo` and `redo` only move an index.
class History {
public:
    /// Default: 512 MB of tiles and pictures that no newer document shares.
    explicit History(Document first, std::size_t byteLimit = std::size_t{512} << 20);

    /// What is shown: the preview if a gesture is going on, else the last commit.
    const Document& current() const;
    /// Replaces what is shown, as part of a gesture.
    void preview(Document document);
    /// Ends the gesture: what is shown becomes an undo step named `label`; nothing if it equals the last one.
    void commit(std::string label);
    /// Ends the gesture and forgets it.
    void cancel();

    bool canUndo() const;
    bool canRedo() const;
    /// A gesture in progress is cancelled first and counts as the undo.
    void undo();
    void redo();
    std::string undoLabel() const;  ///< empty when there is nothing to undo
    std::string redoLabel() const;

    /// Counts every change of what is committed, undo and redo included: what autosave watches.
    std::size_t revision() const { return revision_; }
    std::size_t steps() const { return steps_.size(); }
    std::size_t position() const { return position_; }
    const std::string& labelAt(std::size_t step) const { return steps_[step].label; }

private:
    struct Step {
        Document document;
        std::string label;
        std::size_t bytes = 0;  ///< not shared with the step before
    };
    void trim();

    std::vector<Step> steps_;
    std::size_t position_ = 0;
    bool previewing_ = false;
    Document preview_;
    std::size_t byteLimit_;
    std::size_t bytes_ = 0;
    std::size_t revision_ = 0;
};

}  // namespace ilf
