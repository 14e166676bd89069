// Signals as a readable descriptor, so that they are handled where the loop waits and nowhere else.
#pragma once

#include <initializer_list>
#include <vector>

namespace ilf::app {

/// Blocks `signals` in this thread and all it starts; make it before the first thread. SIGPIPE and SIGHUP are ignored.
class Signals {
public:
    explicit Signals(std::initializer_list<int> signals);
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    int descriptor() const { return fd_; }
    /// Those that came since the last call; waits at most this long for the first one.
    std::vector<int> arrived(int timeout_ms) const;

private:
    int fd_ = -1;
};

}  // namespace ilf::app
