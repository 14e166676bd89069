#include "app/output_core/signals.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace ilf::app {

Signals::Signals(std::initializer_list<int> signals) {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGHUP, SIG_IGN);
    sigset_t set;
    sigemptyset(&set);
    for (const int s : signals)
        sigaddset(&set, s);
    sigprocmask(SIG_BLOCK, &set, nullptr);
    fd_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

Signals::~Signals() { close(fd_); }

std::vector<int> Signals::arrived(int timeout_ms) const {
    pollfd item{fd_, POLLIN, 0};
    poll(&item, 1, timeout_ms);
    std::vector<int> out;
    signalfd_siginfo info{};
    while (read(fd_, &info, sizeof info) == sizeof info)
        out.push_back(static_cast<int>(info.ssi_signo));
    return out;
}

}  // namespace ilf::app
