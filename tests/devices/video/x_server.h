// X servers for tests: with a number of their own, gone at the end of the test however it ends.
#pragma once

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <poll.h>
#include <signal.h>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "devices/rig/video_output.h"
#include "tests/support/run_program.h"

namespace ilf::test {

/// Sets DISPLAY while it lives.
class XServer {
public:
    /// `arguments`: the program, and what it is told beside its number.
    explicit XServer(std::vector<std::string> arguments, const std::string& number = "") {
#if defined(__SANITIZE_THREAD__)
        return;  // it cannot judge the threads of Mesa, which was not built with it
#endif
        std::array<int, 2> told{};
        if (pipe2(told.data(), O_CLOEXEC) != 0) return;
        arguments.insert(arguments.end(), {"-displayfd", "200", "-noreset", "-nolisten", "tcp"});
        if (!number.empty()) arguments.insert(arguments.begin() + 1, ":" + number);
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            const int nothing = open("/dev/null", O_RDWR);
            for (const int fd : {0, 1, 2})
                dup2(nothing, fd);
            dup2(told[1], 200);
            unsetenv("LD_PRELOAD");
            execvp(argv[0], argv.data());
            _exit(127);
        }
        close(told[1]);
        std::string line;
        pollfd waited{told[0], POLLIN, 0};
        char c = 0;
        // The number comes once the server answers; a server that cannot start closes the pipe.
        while (poll(&waited, 1, 20000) == 1 && read(told[0], &c, 1) == 1 && c != '\n')
            line += c;
        close(told[0]);
        if (line.empty() || c != '\n') {
            kill();
            return;
        }
        number_ = line;
        setenv("DISPLAY", (":" + number_).c_str(), 1);
    }
    static XServer xvfb(const std::string& screen, const std::string& number = "") {
        return XServer({"Xvfb", "-screen", "0", screen}, number);
    }
    ~XServer() {
        kill();
        unsetenv("DISPLAY");
    }
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;

    bool runs() const { return !number_.empty(); }
    const std::string& number() const { return number_; }
    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = -1;
        // Killed, it could not tidy up, and a new server of this number would think it still runs.
        if (number_.empty()) return;
        unlink(("/tmp/.X" + number_ + "-lock").c_str());
        unlink(("/tmp/.X11-unix/X" + number_).c_str());
    }

private:
    pid_t pid_ = -1;
    std::string number_;
};

/// Two screens of a graphics card that is not there: DUMMY0, the operator's, 1024x768 and primary; DUMMY1 unplugged.
class TwoDisplays {
public:
    TwoDisplays() {
        if (geteuid() != 0) return;  // Xorg may be started by root only where there is no console
        std::ofstream(folder_ / "xorg.conf") << R"(
Section "ServerFlags"
  Option "AutoAddDevices" "false"
EndSection
Section "Device"
  Identifier "card"
  Driver "dummy"
  VideoRam 262144
EndSection
Section "Monitor"
  Identifier "monitor"
  HorizSync 5-1000
  VertRefresh 5-300
EndSection
Section "Screen"
  Identifier "screen"
  Device "card"
  Monitor "monitor"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Virtual 4096 2160
    Modes "1024x768"
  EndSubSection
EndSection
)";
        server_.emplace(std::vector<std::string>{"Xorg", "-config", folder_ / "xorg.conf", "-logfile", folder_ / "log",
                                                 "+extension", "GLX", "+extension", "RANDR"});
        if (!server_->runs()) return;
        xrandr("--newmode projector 83.68 912 952 1016 1192 1140 1150 1156 1170 +HSync +VSync");
        ready_ = xrandr("--output DUMMY0 --mode 1024x768 --primary");
    }
    bool runs() const { return ready_; }
    bool xrandr(const std::string& arguments) const {
        return std::system(("xrandr " + arguments + " > /dev/null 2>&1").c_str()) == 0;
    }
    /// The display is known, and switched off. To the dummy driver a display is connected once it was on when the
    /// server looked, and for ever after: to be switched off is as near to being unplugged as it comes.
    void plug(const std::string& output, const std::string& mode = "projector") const {
        xrandr("--addmode " + output + " " + mode);
        xrandr("--output " + output + " --mode " + mode + " --pos 3000x0");
        xrandr("--query");
        switchOff(output);
    }
    void switchOn(const std::string& output, const std::string& where = "--right-of DUMMY0") const {
        xrandr("--output " + output + " --mode projector " + where);
    }
    void switchOff(const std::string& output) const { xrandr("--output " + output + " --off"); }

private:
    TemporaryDirectory folder_;
    std::optional<XServer> server_;
    bool ready_ = false;
};

/// This program again, as another process that runs nothing but the (skipped) test case of that name, which talks to
/// the test through two pipes. Killed where nobody stopped it.
class OtherProcess {
public:
    static constexpr int kToldFd = 200, kSaysFd = 201;  // beyond what a test has open

    explicit OtherProcess(std::string testCase, const std::string& preload = "") {
        std::array<int, 2> tell{}, says{};
        if (pipe2(tell.data(), O_CLOEXEC) != 0 || pipe2(says.data(), O_CLOEXEC) != 0) return;
        testCase = "--test-case=" + testCase;
        std::array<char, 11> all{"--no-skip"};
        std::array<char, 16> self{"/proc/self/exe"};
        std::array<char, 10> quiet{"--minimal"};
        std::array<char*, 5> argv{self.data(), all.data(), quiet.data(), testCase.data(), nullptr};
        pid_ = fork();
        if (pid_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            dup2(tell[0], kToldFd);
            dup2(says[1], kSaysFd);
            if (!preload.empty()) setenv("LD_PRELOAD", preload.c_str(), 1);
            execv(argv[0], argv.data());
            _exit(127);
        }
        close(tell[0]);
        close(says[1]);
        tell_ = tell[1];
        says_ = says[0];
    }
    ~OtherProcess() {
        killed();
        close(tell_);
        close(says_);
    }
    OtherProcess(const OtherProcess&) = delete;
    OtherProcess& operator=(const OtherProcess&) = delete;

    /// Waits, 20 seconds at most, for one letter that it says; 0: it said nothing.
    char said() const {
        pollfd waited{says_, POLLIN, 0};
        char letter = 0;
        return poll(&waited, 1, 20000) == 1 && read(says_, &letter, 1) == 1 ? letter : '\0';
    }
    static void say(char letter) { (void)!write(kSaysFd, &letter, 1); }
    void killed() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = -1;
    }
    /// Closes the pipe it listens to; its exit code.
    int stopped() {
        if (pid_ <= 0) return -1;
        close(tell_);
        tell_ = -1;
        int status = 0;
        waitpid(pid_, &status, 0);
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    }

private:
    pid_t pid_ = -1;
    int tell_ = -1, says_ = -1;
};

/// What a part of the desktop shows now, as another program sees it; empty where nothing could be read.
inline devices::VideoFrame seen(int left, int top, Size size) {
    Display* display = XOpenDisplay(nullptr);
    if (display == nullptr) return {};
    XImage* image = XGetImage(display, DefaultRootWindow(display), left, top, static_cast<unsigned>(size.width),
                              static_cast<unsigned>(size.height), AllPlanes, ZPixmap);
    std::vector<std::uint8_t> pixels;
    for (int y = 0; image != nullptr && y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const unsigned shift : {16U, 8U, 0U})
                pixels.push_back(static_cast<std::uint8_t>(pixel >> shift & 255U));
        }
    if (image != nullptr) XDestroyImage(image);
    XCloseDisplay(display);
    return pixels.empty() ? devices::VideoFrame() : devices::VideoFrame(size, 3, std::move(pixels));
}

/// Every pixel another, from a seed.
inline devices::VideoFrame noise(Size size, std::uint32_t seed) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3);
    for (std::uint8_t& value : pixels) {
        seed = seed * 1664525U + 1013904223U;
        value = static_cast<std::uint8_t>(seed >> 24U);
    }
    return {size, 3, std::move(pixels)};
}

}  // namespace ilf::test
