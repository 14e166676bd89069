// A rig that the core has lent to a studio that measures it: what becomes of light and lenses if that studio dies.
#include <spawn.h>
#include <sys/wait.h>

#include "app/output_core/roles.h"
#include "app/rigs.h"
#include "app/studio/measurer.h"
#include "devices/link/rig_environment.h"
#include "devices/rig/usb1208_lens.h"
#include "devices/usb/usb_bus.h"
#include "tests/process/emulated_rig.h"

using namespace ilf;
using namespace ilf::test;
using devices::LightMode;

namespace {

constexpr const char* kWhere = "ILF_LENT_DIRECTORY";
constexpr const char* kMeasures = "(a studio that measures)";
constexpr int kNoLenses = 4;

/// The first step that moves lenses, and never ends.
Result<std::unique_ptr<app::MeasurePlace>> sweepsForEver(const app::MeasureOrder& order, std::function<bool()>,
                                                         devices::MeasureWatch) {
    const auto bus = devices::UsbBus::open();
    if (!bus) std::_Exit(kNoLenses);
    auto link = (*bus)->link(order.rig.devices->lensesAt, 0);
    if (!link) std::_Exit(kNoLenses);
    devices::LensOutputSetup setup;
    setup.transfersInFlight = 20;  // this machine may do much else
    auto lens = devices::Usb1208Lens::open(*std::move(link), setup, 0.0_D);
    if (!lens || !(*lens)->play(shown(1).waveform, 0.0_s)) std::_Exit(kNoLenses);
    while ((*lens)->heartbeat())
        std::this_thread::sleep_for(milliseconds(20));
    std::_Exit(kNoLenses);
}

/// This executable again, as a process that sees the emulated bus; only the case above it.
pid_t studioThatMeasures(const OutputCore& core) {
    const auto rig = devices::rigEnvironment(core.directory());
    REQUIRE(rig);
    std::vector<std::string> variables{std::string(kWhere) + "=" + core.directory().string()};
    for (char** one = environ; *one != nullptr; ++one)
        if (!rig->contains(std::string(*one).substr(0, std::string(*one).find('=')))) variables.emplace_back(*one);
    for (const auto& [name, value] : *rig)
        variables.push_back(name + "=" + value);
    std::vector<char*> environment;
    for (std::string& one : variables)
        environment.push_back(one.data());
    environment.push_back(nullptr);
    std::string self = "/proc/self/exe", onlyThat = std::string("--test-case=") + kMeasures, all = "--no-skip";
    char* arguments[] = {self.data(), onlyThat.data(), all.data(), nullptr};
    pid_t child = 0;
    REQUIRE(posix_spawn(&child, self.c_str(), nullptr, nullptr, arguments, environment.data()) == 0);
    return child;
}

bool lensesSweep(const OutputCore& core, milliseconds time) {
    auto client = core.devicesClient();
    const auto deadline = Clock::now() + time;
    while (Clock::now() < deadline) {
        if (const auto now = seen(client); now && !now->atRest(0.0_D)) return true;
        std::this_thread::sleep_for(milliseconds(20));
    }
    return false;
}

}  // namespace

TEST_CASE("(a studio that measures)" * doctest::skip()) {  // no test: the one below runs it as a process of its own
    const char* where = std::getenv(kWhere);
    REQUIRE(where != nullptr);
    app::Measurer measurer(where, {}, &sweepsForEver);
    REQUIRE(measurer.offer("room.json", app::emulatedRig()));
    ui::MeasureSetup setup;
    setup.projector = false;
    setup.known = "-50,-3\n50,3";
    setup.temperature = "30";
    measurer.begin(setup);
    measurer.devicesAreFree({});
    while (true)
        pause();
}

TEST_CASE(
    "a lent rig: the studio that measures it is killed while lenses sweep; they rest, below light that stays white") {
#if defined(__SANITIZE_THREAD__)
    MESSAGE("SKIPPED: the thread sanitizer cannot judge umockdev's and GLib's own threads");
    return;
#endif
    OutputCore core("datasheet", "emulated", true);
    {
        auto link = core.connected();
        if (!ready(link)) return;
    }
    int black = 0;
    CHECK(becomesSafe(core, seconds(5), 0.0_D, black));
    REQUIRE(app::stopSupervisor(core.directory(), false) == 0);  // as the studio's link lends devices
    REQUIRE(core.player() == 0);
    REQUIRE(core.guard() != 0);
    CHECK_FALSE(app::stageIsMarked(core.directory()));
    CHECK(becomesSafe(core, seconds(5), 0.0_D, black));

    const pid_t studio = studioThatMeasures(core);
    REQUIRE(lensesSweep(core, seconds(20)));
    CHECK(core.player() == studio);  // whose lock it is as long as it has the rig
    CHECK(app::stageIsMarked(core.directory()));
    // A core that is started meanwhile would find the rig taken; the guard leaves it alone.
    std::this_thread::sleep_for(milliseconds(700));
    CHECK(lensesSweep(core, seconds(1)));

    kill(studio, SIGKILL);
    waitpid(studio, nullptr, 0);
    CHECK(becomesSafe(core, seconds(15), 0.0_D, black));
    CHECK(black == 0);
    CHECK(unmarked(core, seconds(10)));

    core.start();
    auto next = core.connected();
    REQUIRE(ready(next));
    CHECK(next.status().light == LightMode::steady);
}
