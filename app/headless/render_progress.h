// A line on a terminal that says how far a batch is.
#pragma once

#include <ostream>
#include <string>

namespace ilf::app {

/// Draws over its own line: whatever else is printed must come after `cleared`. Where the stream is no terminal
/// (`width` 0), it is silent.
class RenderProgress {
public:
    RenderProgress(std::ostream& out, int width) : out_(out), width_(width) {}
    ~RenderProgress() { cleared(); }
    RenderProgress(const RenderProgress&) = delete;
    RenderProgress& operator=(const RenderProgress&) = delete;

    /// `done` of the whole, 0..1, and what is worked on now.
    void show(double done, const std::string& doing);
    void cleared();

private:
    std::ostream& out_;
    int width_;
    bool shown_ = false;
};

/// Columns of the terminal that standard error is, or 0.
int terminalWidth();

}  // namespace ilf::app
