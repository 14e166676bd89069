// What systemd wants to hear of a service (sd_notify(3)): plain datagrams to the socket it names, no library.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace ilf::app {

/// Without NOTIFY_SOCKET in the environment it tells nobody. Variables are taken out of the environment, so that
/// children do not speak for this process; make it before the first thread.
class ServiceManager {
public:
    ServiceManager();
    ~ServiceManager();
    ServiceManager(const ServiceManager&) = delete;
    ServiceManager& operator=(const ServiceManager&) = delete;

    bool listens() const { return fd_ >= 0; }
    /// READY=1, once.
    void ready();
    /// What `systemctl status` shows; said again only when it changes.
    void status(const std::string& line);
    /// WATCHDOG=1, at most twice in the time it allows; to be called often, but only while all is well.
    void alive();
    void stopping();
    /// How often `alive` must be called; none: nobody watches.
    std::optional<std::chrono::microseconds> watchdog() const { return watchdog_; }

private:
    void tell(const std::string& message) const;

    int fd_ = -1;
    std::string address_;  ///< sun_path: begins with a zero byte where the socket is abstract
    std::optional<std::chrono::microseconds> watchdog_;
    std::chrono::steady_clock::time_point fed_{};
    bool ready_ = false;
    std::string said_;
};

}  // namespace ilf::app
