#include "devices/plugin/loaded_plugin.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <future>
#include <limits>
#include <stdexcept>

#include "devices/plugin/plugin_words.h"
#include "tests/devices/plugin/loopback_rig.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

/// A folder of this test's own.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("ilf-plugin-" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

std::string refusal(const fs::path& file) {
    const auto plugin = ProjectorPlugin::load(file);
    return plugin ? "none" : plugin.error().what;
}

std::string refusal(ilf_projector_plugin_entry entry) {
    const auto plugin = ProjectorPlugin::from(entry, "/opt/maker.so");
    return plugin ? "none" : plugin.error().what;
}

/// A plugin that misbehaves as a test wants it: its table, and what its calls do.
struct Scripted {
    ilf_projector_plugin_v1 table{};
    ilf_code code = ILF_OK;
    std::string message;
    bool throws = false, givesNone = false;
    Second takes;
    ilf_description description{};
    ilf_status status{};
    std::vector<std::string> log;
    std::chrono::nanoseconds now{0};
};
Scripted the;  // the boundary has no place for a test's pointers before `open`

ilf_code call(const char* name, ilf_message* message) {
    the.log.emplace_back(name);
    if (the.throws) throw std::runtime_error(name);
    the.now += std::chrono::nanoseconds(static_cast<std::int64_t>(the.takes.si() * 1e9));
    std::memset(message->text, 0, sizeof message->text);
    std::memcpy(message->text, the.message.data(), std::min(the.message.size(), sizeof message->text));
    return the.code;
}

/// What answers as it should, where the script does not say otherwise.
void behave() {
    the = {};
    auto& t = the.table;
    t.struct_size = sizeof t;
    t.version = 1;
    t.name = "scripted";
    t.plugin_version = "2";
    t.tried_on = "";
    t.list = [](ilf_place* places, std::uint32_t, std::uint32_t* count, ilf_message* m) {
        std::memset(places[0].id, 'x', sizeof places[0].id);  // without an end
        *count = 4'000'000'000U;
        return call("list", m);
    };
    t.open = [](const char*, const char*, ilf_projector** projector, ilf_message* m) {
        *projector = the.givesNone ? nullptr : reinterpret_cast<ilf_projector*>(&the);
        return call("open", m);
    };
    t.close = [](ilf_projector*, ilf_message* m) { return call("close", m); };
    t.describe = [](ilf_projector*, ilf_description* d, ilf_message* m) {
        *d = the.description;
        return call("describe", m);
    };
    t.configure = [](ilf_projector*, const ilf_configuration*, ilf_message* m) { return call("configure", m); };
    t.upload = [](ilf_projector*, const ilf_frame*, ilf_message* m) { return call("upload", m); };
    t.swap = [](ilf_projector*, std::uint64_t, ilf_message* m) { return call("swap", m); };
    t.start = [](ilf_projector*, ilf_message* m) { return call("start", m); };
    t.stop = [](ilf_projector*, ilf_message* m) { return call("stop", m); };
    t.steady_white = [](ilf_projector*, ilf_message* m) { return call("steady_white", m); };
    t.status = [](ilf_projector*, ilf_status* s, ilf_message* m) {
        *s = the.status;
        return call("status", m);
    };
    the.description.width_px = 8;
    the.description.height_px = 4;
    the.description.triggers = ILF_TRIGGER_OWN_CLOCK;
    the.description.slots_most = 64;
    the.description.depth_count = 1;
    the.description.depths[0] = {8, 0, 1.0, 1000.0};
    the.status.state = ILF_STATE_STEADY_WHITE;
}

const ilf_projector_plugin_v1* entry(std::uint32_t) { return &the.table; }

Result<std::unique_ptr<PluginProjector>> opened(HangingCall hanging = {}) {
    const auto plugin = ProjectorPlugin::from(entry, "/opt/maker.so");
    REQUIRE(plugin);
    return PluginProjector::open(*plugin, "slot 1", "",
                                 {[] { return the.now; }, [](std::chrono::nanoseconds time) { the.now += time; }},
                                 std::move(hanging));
}

std::string openRefusal() {
    const auto projector = opened();
    return projector ? "none" : projector.error().what;
}

}  // namespace

TEST_CASE("plugin: a file is loaded by its whole path only, and says in one sentence why it is not") {
    const Folder folder;
    const fs::path text = folder.path / "notes.so", copy = folder.path / "copy.so";
    CHECK(refusal("loopback_projector.so") ==
          "The projector plugin loopback_projector.so is not named by its whole path, and plugins are searched for "
          "nowhere; write the path from / on into the rig file.");
    CHECK(refusal(text) == "The projector plugin " + text.string() + " is not there; check the path in the rig file.");
    CHECK(refusal(folder.path).find("is not there") != std::string::npos);
    std::ofstream(text) << "not a library";
    CHECK(refusal(text).find("cannot be loaded (") != std::string::npos);
    fs::copy_file(test::loopbackFile(), copy);
    fs::permissions(copy, fs::perms::others_write, fs::perm_options::add);
    CHECK(refusal(copy) == "The projector plugin " + copy.string() + " is not loaded, since everybody may write " +
                               copy.string() + "; take that right away (chmod o-w), or put the plugin elsewhere.");
    fs::permissions(copy, fs::perms::others_write, fs::perm_options::remove);
    fs::permissions(folder.path, fs::perms::others_write, fs::perm_options::add);
    CHECK(refusal(copy).find("everybody may write " + folder.path.string() + ";") != std::string::npos);
}

TEST_CASE("plugin: a library for something else is told apart from a plugin") {
    // The C library, from wherever this machine keeps it.
    Dl_info where{};
    REQUIRE(dladdr(reinterpret_cast<void*>(&std::abort), &where) != 0);
    if (std::string(where.dli_fname).find("libc.so") == std::string::npos) {
        MESSAGE("skipped: something stands in for the C library here");
        return;
    }
    CHECK(refusal(fs::canonical(where.dli_fname)).find("has no ilf_projector_plugin()") != std::string::npos);
}

TEST_CASE("plugin: another version, a shorter table or a missing call is refused, and named") {
    behave();
    CHECK(refusal(entry) == "none");
    CHECK(refusal([](std::uint32_t) -> const ilf_projector_plugin_v1* { return nullptr; }) ==
          "The projector plugin /opt/maker.so does not know version 1 of what plugins are asked; get one that does.");
    CHECK(refusal([](std::uint32_t) -> const ilf_projector_plugin_v1* { throw 1; }).find("threw") != std::string::npos);
    the.table.version = 2;
    CHECK(refusal(entry) == "The projector plugin /opt/maker.so is of version 2, this program asks version 1; get the "
                            "plugin for this program.");
    behave();
    the.table.struct_size -= 8;
    CHECK(refusal(entry).find("build it again with this program's header") != std::string::npos);

    const auto lacks = [](const char* part, auto lose) {
        behave();
        lose(the.table);
        CHECK(refusal(entry) == std::string("The projector plugin /opt/maker.so lacks \"") + part +
                                    "\", which every plugin needs; tell its author.");
    };
    lacks("name", [](auto& t) { t.name = nullptr; });
    lacks("plugin_version", [](auto& t) { t.plugin_version = nullptr; });
    lacks("list", [](auto& t) { t.list = nullptr; });
    lacks("open", [](auto& t) { t.open = nullptr; });
    lacks("close", [](auto& t) { t.close = nullptr; });
    lacks("describe", [](auto& t) { t.describe = nullptr; });
    lacks("configure", [](auto& t) { t.configure = nullptr; });
    lacks("upload", [](auto& t) { t.upload = nullptr; });
    lacks("swap", [](auto& t) { t.swap = nullptr; });
    lacks("start", [](auto& t) { t.start = nullptr; });
    lacks("stop", [](auto& t) { t.stop = nullptr; });
    lacks("steady_white", [](auto& t) { t.steady_white = nullptr; });
    lacks("status", [](auto& t) { t.status = nullptr; });
}

TEST_CASE("plugin: what it is called, what it was tried on, and which projectors are there") {
    const test::Loopback loopback;
    const auto plugin = test::Loopback::plugin();
    CHECK(plugin.name() == "loopback 1 (loopback_projector.so)");
    CHECK(plugin.triedOn() == "no hardware");
    const auto places = plugin.list();
    REQUIRE(places);
    CHECK(*places == std::vector<ProjectorPlugin::Place>{{"loopback", "Loopback projector (makes no light)"}});

    behave();
    const auto many = ProjectorPlugin::from(entry, "/opt/maker.so")->list();
    REQUIRE(many);
    CHECK(many->size() == 16);
    CHECK(many->front().id == std::string(64, 'x'));
}

TEST_CASE("plugin: every code is told with what would help, and what it says is made fit to be read") {
    behave();
    const auto says = [](ilf_code code, const std::string& message) {
        the.code = code;
        the.message = message;
        return openRefusal();
    };
    CHECK(says(ILF_ABSENT, "No card.") ==
          "scripted 2 (maker.so) could not open the projector: \"No card.\"; connect it "
          "and switch it on, then TAKE.");
    CHECK(says(ILF_BUSY, "").find("\"It says no more than code 3.\"; close the other program") != std::string::npos);
    CHECK(says(ILF_DENIED, "").find("right to use it") != std::string::npos);
    CHECK(says(-77, "?").find("(Code -77.)") != std::string::npos);
    CHECK(says(ILF_FAILED, "a\nb\x01\xff\xc3\xa4 ").find("\"a b ?\xc3\xa4\"") != std::string::npos);
    CHECK(says(ILF_FAILED, std::string(600, 'y')).size() < 700);
    CHECK(the.log.size() == 6);  // nothing was opened, so nothing else was called
}

TEST_CASE("plugin: descriptions that cannot be are refused, and the projector is left in white") {
    const auto with = [](auto change) {
        behave();
        change(the.description);
        auto why = openRefusal();
        CHECK(the.log == std::vector<std::string>{"open", "describe", "steady_white", "close"});
        return why;
    };
    CHECK(with([](auto& d) { d.width_px = 0; }) ==
          "scripted 2 (maker.so) describes a projector that cannot be (0x4 pixels); tell its author, or get a newer "
          "one.");
    CHECK(with([](auto& d) { d.height_px = 4'000'000'000U; }).find("pixels") != std::string::npos);
    CHECK(with([](auto& d) { d.triggers = 64; }).find("trigger") != std::string::npos);
    CHECK(with([](auto& d) { d.slots_most = 0; }).find("0 slots") != std::string::npos);
    CHECK(with([](auto& d) { d.depth_count = 9; }).find("9 bit depths") != std::string::npos);
    CHECK(with([](auto& d) { d.depths[0].bits = 12; }).find("12 bits") != std::string::npos);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    CHECK(with([](auto& d) { d.depths[0].fastest_hz = kNone; }).find("rates") != std::string::npos);
    CHECK(with([](auto& d) { d.depths[0].slowest_hz = 2000.0; }).find("rates") != std::string::npos);
    behave();
    the.givesNone = true;
    CHECK(openRefusal() == "scripted 2 (maker.so) opened a projector and gave none; tell its author.");
}

TEST_CASE("plugin: any call may fail, throw or be late, and is told; late white is white") {
    behave();
    auto projector = opened();
    REQUIRE(projector);
    const Image<std::uint8_t> picture({8, 4}, 1, std::vector<std::uint8_t>(32, 7));
    const std::vector<std::pair<std::string, std::function<Result<void>()>>> calls{
        {"configure", [&] { return (*projector)->configure({}); }},
        {"upload", [&] { return (*projector)->upload(0, picture); }},
        {"swap", [&] { return (*projector)->swap(1); }},
        {"start", [&] { return (*projector)->start(); }},
        {"stop", [&] { return (*projector)->stop(); }},
        {"steady_white", [&] { return (*projector)->steadyWhite(); }},
        {"status", [&] { return (*projector)->status().map([](const PluginStatus&) {}); }}};
    for (const auto& [name, order] : calls) {
        CAPTURE(name);
        CHECK(order());
        CHECK((*projector)->remark().empty());
        the.code = ILF_FAILED;
        CHECK_FALSE(order());
        the.code = ILF_OK;
        the.throws = true;
        CHECK(order().error().what.find("threw an exception") != std::string::npos);
        the.throws = false;
    }
    the.takes = 3.0_s;
    for (const auto& [name, order] : calls) {
        CAPTURE(name);
        const auto late = order();
        CHECK(late.has_value() == (name == "steady_white"));
        CHECK((*projector)->remark().find("took 3.00 s to ") != std::string::npos);
    }
    the.throws = true;  // closing throws as well
    projector->reset();
    CHECK(the.log.back() == "close");
}

TEST_CASE("plugin: a call that does not come back is noticed while it hangs, and one that does is not") {
    behave();
    static std::promise<std::string> noticed;
    noticed = {};
    the.table.status = [](ilf_projector*, ilf_status* s, ilf_message*) -> ilf_code {
        s->state = ILF_STATE_STEADY_WHITE;
        // Comes back only once somebody noticed.
        return noticed.get_future().wait_for(std::chrono::seconds(60)) == std::future_status::ready ? ILF_OK
                                                                                                    : ILF_FAILED;
    };
    std::vector<std::string> told;
    const auto projector = opened({[&](const std::string& sentence) {
                                       told.push_back(sentence);
                                       noticed.set_value(sentence);
                                   },
                                   0.0_s});
    REQUIRE(projector);
    REQUIRE((*projector)->steadyWhite());
    REQUIRE((*projector)->status());
    CHECK(told == std::vector<std::string>{
                      "scripted 2 (maker.so) was asked to say how the projector is and did not come back"});
}

TEST_CASE("plugin: counters and states that cannot be are told, and errors in words") {
    behave();
    const auto projector = opened();
    REQUIRE(projector);
    const auto said = [&] {
        const auto status = (*projector)->status();
        return !status ? status.error().what : status->troubles.empty() ? "" : status->troubles.front();
    };
    the.status.frames_in = 100;
    the.status.frames_out = 90;
    the.status.frames_waiting = 4;
    CHECK((*projector)->status()->dropped == 6);
    the.status.frames_waiting = 11;
    CHECK(said().find("says of the projector what cannot be (90 frames shown of 100") != std::string::npos);
    the.status.frames_waiting = 0;
    the.status.frames_out = 101;
    CHECK(said().find("what cannot be") != std::string::npos);
    the.status.frames_out = the.status.frames_in = 99;
    CHECK(said().find("counts its frames anew") != std::string::npos);
    the.status.frames_out = the.status.frames_in = 100;
    the.status.state = 17;
    CHECK(said().find("state 17") != std::string::npos);
    the.status.state = ILF_STATE_PLAYING;
    the.status.slot_rate_hz = -1.0;
    CHECK(said().find("what cannot be") != std::string::npos);
    the.status.slot_rate_hz = 0.0;
    the.status.errors = ILF_ERROR_DMA_TIMEOUT;
    CHECK(said().find("DMA timeout") != std::string::npos);
    the.status.errors = ILF_ERROR_NO_TRIGGER;
    CHECK(said().find("no triggers") != std::string::npos);
    the.status.errors = ILF_ERROR_RATE_OVERFLOW;
    CHECK(said().find("faster than the projector can show") != std::string::npos);
    the.status.errors = 0x10000;
    CHECK(said().find("(65536, 0)") != std::string::npos);
    the.status.errors = 0;
    CHECK(said().empty());
}

TEST_CASE("plugin: whatever bytes a plugin says, the operator gets short valid text") {
    law("text", [](const std::vector<std::uint8_t>& bytes) {
        const std::string raw(bytes.begin(), bytes.end());
        const std::string text = pluginText(raw.data(), raw.size());
        RC_ASSERT(text.size() <= raw.size());
        for (const char c : text)
            RC_ASSERT(static_cast<unsigned char>(c) >= 0x20);
        RC_ASSERT(pluginText(text.data(), text.size()) == text);
    });
}

}  // namespace ilf::devices
