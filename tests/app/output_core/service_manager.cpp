#include "app/output_core/service_manager.h"

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/projects/folder.h"

namespace ilf::app {
namespace {

/// The manager's end, and the environment that names it.
class Manager {
public:
    explicit Manager(std::string name) : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
        setenv("NOTIFY_SOCKET", name.c_str(), 1);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const bool abstractName = name[0] == '@';
        if (abstractName) name[0] = '\0';
        std::memcpy(address.sun_path, name.data(), name.size());
        const auto length = offsetof(sockaddr_un, sun_path) + name.size() + (abstractName ? 0 : 1);
        REQUIRE(bind(fd_, reinterpret_cast<sockaddr*>(&address), static_cast<socklen_t>(length)) == 0);
    }
    ~Manager() {
        close(fd_);
        for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"})
            unsetenv(name);
    }
    std::vector<std::string> heard() const {
        std::vector<std::string> out;
        std::array<char, 512> buffer{};
        for (ssize_t n = 0; (n = recv(fd_, buffer.data(), buffer.size(), 0)) > 0;)
            out.emplace_back(buffer.data(), static_cast<std::size_t>(n));
        return out;
    }

private:
    int fd_;
};

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("service manager: hears when the core is ready, how it is, and that it stops") {
    Folder folder;
    for (const std::string& name : {(folder / "notify").string(), "@ilf-test-notify-" + std::to_string(getpid())}) {
        const Manager manager(name);
        ServiceManager service;
        CHECK(service.listens());
        CHECK(std::getenv("NOTIFY_SOCKET") == nullptr);  // children do not speak for it
        CHECK_FALSE(service.watchdog());
        service.alive();  // nobody watches
        service.ready();
        service.ready();
        service.status("Steady white light,\nlens at rest.");
        service.status("Steady white light,\nlens at rest.");
        service.stopping();
        CHECK(manager.heard() == Words{"READY=1", "STATUS=Steady white light, lens at rest.", "STOPPING=1"});
    }
}

TEST_CASE("service manager: its watchdog is fed twice in the time it allows, however often it is called") {
    Folder folder;
    const Manager manager((folder / "notify").string());
    setenv("WATCHDOG_USEC", "250000", 1);
    setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
    ServiceManager service;
    CHECK(service.watchdog() == std::chrono::milliseconds(250));
    const auto begun = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(500)) {
        service.alive();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const auto fed = manager.heard();
    CHECK(fed.size() >= 3);
    CHECK(fed.size() <= 6);
    CHECK(fed.front() == "WATCHDOG=1");
}

TEST_CASE("service manager: what is meant for another process, or for nobody, is left alone") {
    {
        Folder folder;
        const Manager manager((folder / "notify").string());
        setenv("WATCHDOG_USEC", "250000", 1);
        setenv("WATCHDOG_PID", "1", 1);
        CHECK_FALSE(ServiceManager().watchdog());
    }
    ServiceManager nobody;
    CHECK_FALSE(nobody.listens());
    nobody.ready();
    setenv("NOTIFY_SOCKET", "not/absolute", 1);
    CHECK_FALSE(ServiceManager().listens());
    setenv("NOTIFY_SOCKET", ("/" + std::string(200, 'x')).c_str(), 1);
    CHECK_FALSE(ServiceManager().listens());
}

}  // namespace ilf::app
