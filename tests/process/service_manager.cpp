// The whole core as a service: what systemd is told by it.
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/process/output_core.h"

using namespace ilf;
using namespace ilf::test;

namespace {

/// Systemd's end; in the environment of the core that is started next.
class Manager {
public:
    explicit Manager(const std::string& name) : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        REQUIRE(bind(fd_, reinterpret_cast<sockaddr*>(&address), length) == 0);
        setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
        setenv("WATCHDOG_USEC", "1000000", 1);
    }
    ~Manager() {
        close(fd_);
        unsetenv("NOTIFY_SOCKET");
        unsetenv("WATCHDOG_USEC");
    }
    /// Waits for one that begins so.
    bool hears(const std::string& start, milliseconds time) {
        const auto deadline = Clock::now() + time;
        while (Clock::now() < deadline) {
            std::array<char, 512> buffer{};
            const auto n = recv(fd_, buffer.data(), buffer.size(), 0);
            if (n > 0 && std::string(buffer.data(), static_cast<std::size_t>(n)).starts_with(start)) return true;
            if (n <= 0) std::this_thread::sleep_for(milliseconds(10));
        }
        return false;
    }
    void forget() {
        std::array<char, 512> buffer{};
        while (recv(fd_, buffer.data(), buffer.size(), 0) > 0) {
        }
    }

private:
    int fd_;
};

}  // namespace

TEST_CASE("the core as a service: ready once the player was heard, alive while it is, and what it does in words") {
    Manager manager("ilf-test-service-" + std::to_string(getpid()));
    const OutputCore core;
    CHECK(manager.hears("READY=1", seconds(10)));
    CHECK(manager.hears("WATCHDOG=1", seconds(2)));
    auto link = core.connected();
    OutputCore::take(link, program(1), 1);
    CHECK(manager.hears("STATUS=Slotted light", seconds(3)));
    CHECK(manager.hears("WATCHDOG=1", seconds(2)));

    const int player = core.player();
    kill(player, SIGSTOP);
    CHECK(manager.hears("STATUS=The player does not answer", seconds(3)));
    manager.forget();
    CHECK_FALSE(manager.hears("WATCHDOG=1", milliseconds(1500)));
    kill(player, SIGCONT);
    CHECK(manager.hears("WATCHDOG=1", seconds(3)));

    kill(core.supervisor(), SIGTERM);
    CHECK(manager.hears("STOPPING=1", seconds(3)));
}
