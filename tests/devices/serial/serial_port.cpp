#include "devices/serial/serial_port.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace ilf::devices {
namespace {

/// A pseudo-terminal whose other end the test holds.
struct Pty {
    int other = -1;
    std::string path;
    Pty() {
        std::array<char, 128> name{};
        int port = -1;
        REQUIRE(openpty(&other, &port, name.data(), nullptr, nullptr) == 0);
        path = name.data();
        kept = port;
    }
    ~Pty() { hangUp(); }
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;
    void hangUp() {
        if (kept >= 0) close(kept);
        if (other >= 0) close(other);
        kept = other = -1;
    }
    int kept = -1;
};

bool says(const Error& error, const std::string& words) { return error.what.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("serial port: bytes go through a pseudo-terminal unchanged, every value of them") {
    Pty pty;
    auto port = openSerialPort(pty.path);
    REQUIRE(port);
    CHECK((*port)->name() == pty.path);
    Bytes all;
    for (int value = 0; value < 256; ++value)
        all.push_back(static_cast<std::uint8_t>(value));
    REQUIRE((*port)->send(all, Milliseconds(1000)));
    Bytes out(256);
    std::size_t got = 0;
    while (got < out.size()) {
        const auto more = read(pty.other, out.data() + got, out.size() - got);
        REQUIRE(more > 0);
        got += static_cast<std::size_t>(more);
    }
    CHECK(out == all);

    REQUIRE(write(pty.other, all.data(), all.size()) == 256);
    Bytes in;
    while (in.size() < 256) {
        const auto more = (*port)->receive(100, Milliseconds(1000));
        REQUIRE(more);
        REQUIRE_FALSE(more->empty());
        CHECK(more->size() <= 100);
        in.insert(in.end(), more->begin(), more->end());
    }
    CHECK(in == all);
}

TEST_CASE("serial port: nothing to read is nothing, after the time limit and not before") {
    Pty pty;
    auto port = openSerialPort(pty.path);
    REQUIRE(port);
    const auto before = std::chrono::steady_clock::now();
    const auto nothing = (*port)->receive(10, Milliseconds(30));
    REQUIRE(nothing);
    CHECK(nothing->empty());
    CHECK(std::chrono::steady_clock::now() - before >= Milliseconds(30));
    CHECK((*port)->receive(10, Milliseconds(0))->empty());
}

TEST_CASE("serial port: a port that takes no more data is an error after the time limit") {
    Pty pty;
    auto port = openSerialPort(pty.path);
    REQUIRE(port);
    const auto full = (*port)->send(Bytes(1 << 20), Milliseconds(30));
    REQUIRE_FALSE(full);
    CHECK(says(full.error(), "took no more data for 30 ms"));
}

TEST_CASE("serial port: when the device is pulled out, every call says that it is gone") {
    Pty pty;
    auto port = openSerialPort(pty.path);
    REQUIRE(port);
    pty.hangUp();
    const auto received = (*port)->receive(10, Milliseconds(500));
    REQUIRE_FALSE(received);
    CHECK(received.error().fault == Fault::device);
    CHECK(says(received.error(), "is gone"));
    const auto sent = (*port)->send(Bytes{1, 2, 3}, Milliseconds(500));
    REQUIRE_FALSE(sent);
    CHECK(says(sent.error(), "is gone"));
}

TEST_CASE("serial port: it is raw, at 115200 baud, and does not hang up when closed") {
    Pty pty;
    auto port = openSerialPort(pty.path);
    REQUIRE(port);
    termios line{};
    REQUIRE(tcgetattr(pty.kept, &line) == 0);
    CHECK(cfgetospeed(&line) == B115200);
    CHECK((line.c_lflag & (ICANON | ECHO | ISIG)) == 0U);
    CHECK((line.c_oflag & OPOST) == 0U);
    CHECK((line.c_cflag & HUPCL) == 0U);
    CHECK((line.c_cflag & CLOCAL) != 0U);
}

TEST_CASE("serial port: what is not there, not a port, or not allowed is refused with what would help") {
    CHECK(openSerialPort("/dev/ttyNoSuchPort").error().fault == Fault::notFound);
    const auto file = std::filesystem::temp_directory_path() / ("ilf-serial-" + std::to_string(getpid()));
    std::ofstream(file) << "x";
    CHECK(says(openSerialPort(file.string()).error(), "is not a serial port"));
    std::filesystem::permissions(file, std::filesystem::perms::none);
    if (geteuid() == 0) {
        MESSAGE("run as root, which may open everything: the permission's sentence is not tested");
    } else {
        CHECK(says(openSerialPort(file.string()).error(), "dialout"));
    }
    std::filesystem::remove(file);
}

}  // namespace ilf::devices
