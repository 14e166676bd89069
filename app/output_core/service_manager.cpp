#include "app/output_core/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace ilf::app {
namespace {

/// The variable's value; taken out of the environment.
std::string taken(const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before the first thread
    std::string text = value != nullptr ? value : "";
    unsetenv(name);  // NOLINT(concurrency-mt-unsafe)
    return text;
}

std::optional<long long> number(const std::string& text) {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

ServiceManager::ServiceManager() : address_(taken("NOTIFY_SOCKET")) {
    const auto limit_us = number(taken("WATCHDOG_USEC"));
    const auto meant = number(taken("WATCHDOG_PID"));
    const bool path = address_.starts_with('/'), abstractName = address_.starts_with('@');
    if ((!path && !abstractName) || address_.size() >= sizeof(sockaddr_un::sun_path)) return;
    if (abstractName) address_[0] = '\0';
    fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (limit_us && *limit_us > 0 && (!meant || *meant == getpid())) watchdog_ = std::chrono::microseconds(*limit_us);
}

ServiceManager::~ServiceManager() {
    if (fd_ >= 0) close(fd_);
}

void ServiceManager::tell(const std::string& message) const {
    if (fd_ < 0) return;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(address_.begin(), address_.end(), address.sun_path);
    const auto length =
        static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size() + (address_[0] == '\0' ? 0 : 1));
    // A manager that does not listen is its own affair.
    (void)sendto(fd_, message.data(), message.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
                 length);
}

void ServiceManager::ready() {
    if (ready_) return;
    ready_ = true;
    tell("READY=1");
}

void ServiceManager::status(const std::string& line) {
    if (line == said_) return;
    said_ = line;
    std::string oneLine = line;
    std::replace(oneLine.begin(), oneLine.end(), '\n', ' ');
    tell("STATUS=" + oneLine);
}

void ServiceManager::alive() {
    if (!watchdog_) return;
    const auto now = std::chrono::steady_clock::now();
    // A little early, since whoever calls looks only now and then.
    if (fed_ != std::chrono::steady_clock::time_point{} && now - fed_ < *watchdog_ * 2 / 5) return;
    fed_ = now;
    tell("WATCHDOG=1");
}

void ServiceManager::stopping() { tell("STOPPING=1"); }

}  // namespace ilf::app
