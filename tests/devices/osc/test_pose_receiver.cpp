// Poses by OSC: what is understood, what is refused, and that no bytes do harm.
#include "devices/osc/pose_receiver.h"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <thread>

#include "devices/camera/frame.h"
#include "tests/support/fuzz.h"

namespace ilf::devices {

namespace {

/// OSC written by hand from the OSC 1.0 specification, not by the library under test.
std::vector<std::byte> padded(const std::string& text) {
    std::vector<std::byte> out;
    for (const char c : text)
        out.push_back(static_cast<std::byte>(c));
    do
        out.push_back(std::byte{0});
    while (out.size() % 4 != 0);
    return out;
}

void add(std::vector<std::byte>& to, std::uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8)
        to.push_back(static_cast<std::byte>(word >> static_cast<unsigned>(shift) & 0xFFU));
}

void add(std::vector<std::byte>& to, float value) {
    std::uint32_t word = 0;
    std::memcpy(&word, &value, 4);
    add(to, word);
}

void add(std::vector<std::byte>& to, const std::vector<std::byte>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

std::vector<std::byte> message(const std::string& address, const std::vector<float>& numbers) {
    auto bytes = padded(address);
    add(bytes, padded("," + std::string(numbers.size(), 'f')));
    for (const float number : numbers)
        add(bytes, number);
    return bytes;
}

std::vector<std::byte> bundle(std::uint32_t seconds, const std::vector<std::vector<std::byte>>& parts) {
    auto bytes = padded("#bundle");
    add(bytes, seconds);
    add(bytes, std::uint32_t{0x80000000});  // and a half
    for (const auto& part : parts) {
        add(bytes, static_cast<std::uint32_t>(part.size()));
        add(bytes, part);
    }
    return bytes;
}

constexpr double kNow = 1'000'000.75;
constexpr auto kNtp = std::uint32_t{2208988800U + 1'000'000U};

}  // namespace

TEST_CASE("poses are read with two to five arguments") {
    auto says = poseMessage(message("/pose/1", {0.25F, 0.5F}), kNow);
    REQUIRE(says);
    REQUIRE(says->poses.size() == 1);
    CHECK(says->poses[0] == OscPose{"/pose/1", 0.25, 0.5, {}, 0.0, 1.0, {}});
    says = poseMessage(message("/pose/12", {0.25F, 0.5F, 1.5F, 90.0F, 0.5F}), kNow);
    REQUIRE(says);
    CHECK(says->poses[0] == OscPose{"/pose/12", 0.25, 0.5, 1.5, 90.0, 0.5, {}});
}

TEST_CASE("whole numbers are numbers, too") {
    auto bytes = padded("/pose/3");
    add(bytes, padded(",ii"));
    add(bytes, std::uint32_t{1});
    add(bytes, std::uint32_t{0});
    const auto says = poseMessage(bytes, kNow);
    REQUIRE(says);
    CHECK(says->poses[0].x == 1.0);
}

TEST_CASE("numbers of eight bytes are read where four-byte ones have moved them") {
    auto bytes = padded("/pose/4");
    add(bytes, padded(",fdh"));
    add(bytes, 0.25F);
    add(bytes, std::uint32_t{0x3FE00000});  // 0.5 as a double
    add(bytes, std::uint32_t{0});
    add(bytes, std::uint32_t{0});
    add(bytes, std::uint32_t{2});
    const auto says = poseMessage(bytes, kNow);
    REQUIRE(says);
    REQUIRE(says->poses.size() == 1);
    CHECK(says->poses[0].y == 0.5);
    CHECK(says->poses[0].z_m == 2.0);
}

TEST_CASE("a bundle's time tag tells how old its poses are; another clock's is not believed") {
    const auto one = message("/pose/1", {0.1F, 0.2F}), two = message("/pose/2", {0.3F, 0.4F});
    auto says = poseMessage(bundle(kNtp, {one, bundle(0, {two})}), kNow);
    REQUIRE(says);
    REQUIRE(says->poses.size() == 2);
    CHECK(says->poses[0].secondsAgo.value() == doctest::Approx(0.25).epsilon(1e-6));
    CHECK(says->poses[1].address == "/pose/2");
    says = poseMessage(bundle(kNtp + 3600, {one}), kNow);
    REQUIRE(says);
    CHECK(!says->poses[0].secondsAgo);
}

TEST_CASE("what is wrong is refused in one sentence") {
    const auto why = [](const std::vector<std::byte>& bytes) {
        const auto says = poseMessage(bytes, kNow);
        return says ? std::string("accepted") : says.error().what;
    };
    CHECK(why({}).find("no OSC") != std::string::npos);
    CHECK(why(padded("hello")).find("no OSC") != std::string::npos);
    CHECK(why(message("/pose/1", {0.5F})).find("1 arguments") != std::string::npos);
    CHECK(why(message("/pose/1", {7.0F, 0.5F})).find("outside the picture") != std::string::npos);
    CHECK(why(message("/pose/1", {NAN, 0.5F})).find("no number") != std::string::npos);
    CHECK(why(message("/pose/1", {0.5F, 0.5F, -1.0F})).find("1000 m") != std::string::npos);
    CHECK(why(message("/pose/1", {0.5F, 0.5F, 1.0F, 0.0F, 2.0F})).find("confidence") != std::string::npos);
    auto cut = message("/pose/1", {0.5F, 0.5F});
    cut.resize(cut.size() - 4);
    CHECK(why(cut).find("cut short") != std::string::npos);
    auto deep = message("/pose/1", {0.5F, 0.5F});
    for (int i = 0; i < 20; ++i)
        deep = bundle(0, {deep});
    CHECK(why(deep).find("too deep") != std::string::npos);
    CHECK(why(bundle(0, {message("/pose/1", {0.5F, 0.5F}), message("/pose/2", {0.5F})})).find("/pose/2") !=
          std::string::npos);
}

TEST_CASE("addresses that are not in the table are told apart") {
    for (const char* address : {"/pose", "/pose/", "/pose/x", "/pose/-1", "/pose/70000", "/if/go"}) {
        const auto says = poseMessage(message(address, {0.5F, 0.5F}), kNow);
        REQUIRE(says);
        CHECK(says->poses.empty());
        CHECK(says->unknown == std::vector<std::string>{address});
    }
}

TEST_CASE("a hundred thousand datagrams of noise and of damaged messages do no harm") {
    const auto good = bundle(kNtp, {message("/pose/1", {0.1F, 0.2F, 1.0F}), message("/pose/2", {0.3F, 0.4F})});
    int accepted = 0;
    for (Fuzz fuzz; fuzz.goesOn();) {
        std::vector<std::byte> bytes = good;
        if (fuzz.below(2) == 0) {
            bytes = fuzz.bytes<std::byte>(96);
            if (!bytes.empty() && fuzz.below(2) == 0) bytes[0] = std::byte{'/'};
        } else {
            fuzz.damage(bytes);
        }
        const auto says = poseMessage(bytes, kNow);
        if (!says) {
            CHECK(says.error().what.size() < 200);
            continue;
        }
        ++accepted;
        for (const OscPose& pose : says->poses) {
            CHECK(std::isfinite(pose.x));
            CHECK(pose.confidence >= 0.0);
            CHECK(pose.confidence <= 1.0);
        }
    }
    CHECK(accepted > 100);  // damage to a number is often a number
}

TEST_CASE("the receiver keeps the newest pose of each address, with its time, and answers unknown ones once") {
    auto receiver = PoseReceiver::open(0);
    REQUIRE(receiver);
    const int out = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>((*receiver)->port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto send = [&](const std::vector<std::byte>& bytes) {
        REQUIRE(::sendto(out, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) ==
                static_cast<ssize_t>(bytes.size()));
    };
    const Second before = steadyNow();
    send(padded("nonsense"));
    send(message("/if/go", {1.0F}));
    send(message("/if/go", {1.0F}));
    send(message("/pose/1", {0.1F, 0.2F}));
    send(message("/pose/2", {0.7F, 0.2F}));
    send(message("/pose/1", {0.3F, 0.4F}));
    std::map<std::string, TimedPose> poses;
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < until && (!poses.contains("/pose/1") || poses["/pose/1"].pose.x < 0.2)) {
        for (const TimedPose& pose : (*receiver)->take())
            poses[pose.pose.address] = pose;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    REQUIRE(poses.size() == 2);
    CHECK(poses["/pose/1"].pose.y == doctest::Approx(0.4));
    CHECK(poses["/pose/1"].time >= before);
    CHECK(poses["/pose/1"].time <= steadyNow());
    CHECK((*receiver)->takeSentences().size() == 2);  // nonsense, and /if/go once
    CHECK((*receiver)->takeSentences().empty());
    char reply[256];
    CHECK(::recv(out, reply, sizeof reply, 0) > 0);
    CHECK(std::string(reply) == "/if/error");
    CHECK(::recv(out, reply, sizeof reply, MSG_DONTWAIT) < 0);

    const auto taken = PoseReceiver::open((*receiver)->port());
    REQUIRE(!taken);
    CHECK(taken.error().what.find("another port") != std::string::npos);
    ::close(out);
}

}  // namespace ilf::devices
