// The lens driver behind a pseudo-terminal, opened and read as any serial port.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "devices/emulators/serial_port_emulator.h"

using namespace ilf::devices::emulators;

namespace {

struct Directory {
    std::filesystem::path path;
    Directory() {
        std::string name = (std::filesystem::temp_directory_path() / "ilf-serial-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~Directory() { std::filesystem::remove_all(path); }
    Directory(const Directory&) = delete;
    Directory& operator=(const Directory&) = delete;
};

struct Port {
    int file;
    explicit Port(const std::filesystem::path& path) : file(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {
        REQUIRE(file >= 0);
    }
    ~Port() { close(file); }
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;

    /// As many bytes as asked for; fewer where they do not come within a second, or at the end.
    std::string read(std::size_t bytes) const {
        std::string text;
        pollfd watched{file, POLLIN, 0};
        while (text.size() < bytes && poll(&watched, 1, 1000) == 1) {
            std::array<char, 64> some{};
            const ssize_t got = ::read(file, some.data(), some.size());
            if (got <= 0) break;
            text.append(some.data(), std::size_t(got));
        }
        return text;
    }
    void write(std::string_view text) const {
        REQUIRE(::write(file, text.data(), text.size()) == ssize_t(text.size()));
    }
};

}  // namespace

TEST_CASE("serial port: a handshake over the pseudo-terminal, bytes unchanged both ways") {
    const Directory directory;
    EmulatedLensDriver driver;
    const auto emulator = SerialPortEmulator::started(driver, directory.path / "ttyACM0");
    REQUIRE(emulator);
    const Port port((*emulator)->link());
    CHECK(isatty(port.file) == 1);
    port.write("Start");
    CHECK(port.read(7) == "Ready\r\n");
    // A current of 0D 0A, a line end inside the data, there and back; 0 is data too.
    using namespace std::string_literals;
    port.write("Aw\x0D\x0A"
               "\x20\xB1"s);
    port.write("Ar\0\0"
               "\xB4\x27"s);
    CHECK(port.read(7) == "A\x0D\x0A"
                          "\xD4\x83"
                          "\r\n"s);
}

TEST_CASE("serial port: pulled, it is at its end for its program; back, it is found at the same place") {
    const Directory directory;
    EmulatedLensDriver driver;
    const auto started = SerialPortEmulator::started(driver, directory.path / "ttyACM0");
    REQUIRE(started);
    SerialPortEmulator& emulator = **started;
    {
        const Port port(emulator.link());
        port.write("Start");
        CHECK(port.read(7) == "Ready\r\n");
        emulator.unplug();
        CHECK(port.read(1).empty());
        pollfd watched{port.file, POLLIN, 0};
        CHECK(poll(&watched, 1, 1000) == 1);
        CHECK((watched.revents & POLLHUP) != 0);
        CHECK_FALSE(std::filesystem::exists(emulator.link()));
        CHECK_FALSE(emulator.plugged());
    }
    REQUIRE(emulator.plug());
    const Port again(emulator.link());
    again.write("Start");
    CHECK(again.read(7) == "Ready\r\n");

    emulator.locked([&](std::int64_t) { driver.setFaults({{Mishap::unplug, 3}}); });
    again.write("Start");
    CHECK(again.read(7).empty());
    CHECK_FALSE(emulator.plugged());
}

TEST_CASE("serial port: a place that is not there is refused in words") {
    EmulatedLensDriver driver;
    const auto emulator = SerialPortEmulator::started(driver, "/nonexistent/directory/ttyACM0");
    REQUIRE_FALSE(emulator);
    CHECK(emulator.error().what.find("/nonexistent/directory/ttyACM0") != std::string::npos);
}
