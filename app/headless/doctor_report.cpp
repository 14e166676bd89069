#include "app/headless/doctor_report.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "devices/survey/known_devices.h"

namespace ilf::app {
namespace {

using devices::Attached;
using devices::MachineCheck;
using devices::Readiness;
using devices::Standing;

constexpr std::size_t kWidth = 96;

std::string numbersOf(const devices::UsbModel& model) {
    char numbers[16];
    std::snprintf(numbers, sizeof numbers, "%04x:%04x", model.vendor, model.product);
    return numbers;
}

const char* title(Readiness state) {
    switch (state) {
    case Readiness::ready:
        return "READY";
    case Readiness::notAsked:
        return "NOT ASKED";
    case Readiness::inOurUse:
        return "PLAYING";
    case Readiness::noPermission:
        return "NO PERMISSION";
    case Readiness::busy:
        return "IN USE";
    case Readiness::silent:
        return "NO ANSWER";
    case Readiness::trouble:
        return "NOT READY";
    case Readiness::unsupported:
        return "NO DRIVER";
    case Readiness::gone:
        break;
    }
    return "UNPLUGGED";
}

/// `text` in lines of at most kWidth, the first after `first`, the others after as many blanks.
void wrapped(std::ostream& out, const std::string& first, const std::string& text) {
    std::string line = first;
    bool begun = false;
    std::size_t from = 0;
    while (from < text.size()) {
        const auto end = std::min(text.find(' ', from), text.size());
        const std::string word = text.substr(from, end - from);
        if (begun && line.size() + 1 + word.size() > kWidth) {
            out << line << '\n';
            line.assign(first.size(), ' ');
            begun = false;
        }
        line += (begun ? " " : "") + word;
        begun = true;
        from = end + 1;
    }
    out << line << '\n';
}

std::string joined(const std::vector<std::string>& parts, const char* between) {
    std::string all;
    for (const std::string& part : parts)
        if (!part.empty()) all += (all.empty() ? "" : between) + part;
    return all;
}

void print(std::ostream& out, const Attached& device) {
    const std::string name = device.kind == devices::DeviceKind::camera
                                 ? device.name + " (camera)"
                                 : device.name + " (" + word(device.kind) + ", " + device.usb + ")";
    out << "  " << std::left << std::setw(14) << title(device.state) << name << '\n';
    const std::string inset(16, ' ');
    const std::string port = device.usb.empty() ? device.where : "USB port " + device.where;
    wrapped(out, inset,
            joined({port, device.node, device.product.empty() ? "" : "calls itself \"" + device.product + "\"",
                    device.serial.empty() ? "" : "serial number " + device.serial},
                   ", "));
    const std::string told = joined({device.firmware.empty() ? "" : "firmware " + device.firmware, device.mode}, "; ");
    if (!told.empty()) wrapped(out, inset, told);
    for (const std::string& trouble : device.troubles)
        wrapped(out, inset + "-> ", trouble);
    for (const std::string& remark : device.remarks)
        wrapped(out, inset, remark);
    out << '\n';
}

void print(std::ostream& out, const MachineCheck& check) {
    const char* mark = check.standing == Standing::good      ? "  ok            "
                       : check.standing == Standing::missing ? "  MISSING       "
                                                             : "  not known     ";
    wrapped(out, mark, check.what);
    if (!check.help.empty()) wrapped(out, std::string(16, ' ') + "-> ", check.help);
    for (const std::string& command : check.commands)
        out << std::string(19, ' ') << "  " << command << '\n';
}

void printNothingAttached(std::ostream& out) {
    out << "No projector, converter, lens driver or camera is attached. Looked for:\n\n";
    for (const devices::KnownDevice& known : devices::kKnownDevices)
        out << "  USB " << numbersOf(known.model) << "  " << known.name << " (" << word(known.kind)
            << (known.driven ? ")\n" : "; no driver in this version)\n");
    out << "  /dev/v4l       cameras\n\n";
    wrapped(out, "",
            "If one should be here: switch its power on, push its USB plug in again, try another cable and "
            "port, then run doctor again. \"lsusb\" must list its number.");
    out << '\n';
    wrapped(out, "",
            "Meanwhile everything works with simulated devices: \"./run.sh\" opens the window, "
            "\"./run.sh run FILE\" plays a project without one.");
    out << '\n';
}

std::string counted(std::size_t number, const char* what) {
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

std::string summary(const DoctorReport& report) {
    const auto bad =
        static_cast<std::size_t>(std::count_if(report.attached.begin(), report.attached.end(),
                                               [](const Attached& device) { return devices::unusable(device.state); }));
    const auto missing = static_cast<std::size_t>(
        std::count_if(report.machine.begin(), report.machine.end(),
                      [](const MachineCheck& check) { return check.standing == Standing::missing; }));
    std::string text;
    if (!report.attached.empty())
        text = bad == 0 ? "No attached device is in trouble."
                        : std::to_string(bad) + " of " + counted(report.attached.size(), "attached device") +
                              " cannot be used as it is: see \"->\" above.";
    if (missing > 0)
        text += (text.empty() ? "" : " ") + counted(missing, "thing") +
                " should be changed on this machine before a show with real devices.";
    return text.empty() ? "Nothing is wrong." : text;
}

nlohmann::ordered_json jsonOf(const Attached& device) {
    return {{"kind", word(device.kind)},
            {"state", word(device.state)},
            {"usable", !devices::unusable(device.state) && device.state != Readiness::unsupported &&
                           device.state != Readiness::gone},
            {"name", device.name},
            {"where", device.where},
            {"node", device.node},
            {"usb", device.usb},
            {"product", device.product},
            {"serial", device.serial},
            {"firmware", device.firmware},
            {"mode", device.mode},
            {"held_by", device.holders},
            {"troubles", device.troubles},
            {"remarks", device.remarks}};
}

}  // namespace

int exitCode(const DoctorReport& report) {
    const bool bad = std::any_of(report.attached.begin(), report.attached.end(),
                                 [](const Attached& device) { return devices::unusable(device.state); });
    return bad ? kDevice : kDone;
}

void printDoctor(std::ostream& out, const DoctorReport& report) {
    if (report.attached.empty()) {
        printNothingAttached(out);
    } else {
        out << "Attached\n\n";
        for (const Attached& device : report.attached)
            print(out, device);
    }
    out << "This machine\n\n";
    for (const MachineCheck& check : report.machine)
        print(out, check);
    out << '\n';
    wrapped(out, "", summary(report));
}

void printDoctorJson(std::ostream& out, const DoctorReport& report) {
    nlohmann::ordered_json json;
    json["devices"] = nlohmann::ordered_json::array();
    for (const Attached& device : report.attached)
        json["devices"].push_back(jsonOf(device));
    json["machine"] = nlohmann::ordered_json::array();
    for (const MachineCheck& check : report.machine)
        json["machine"].push_back({{"id", check.id},
                                   {"standing", word(check.standing)},
                                   {"what", check.what},
                                   {"help", check.help},
                                   {"commands", check.commands}});
    json["output_core"] = {{"running", !report.core.empty()}, {"processes", report.core}};
    json["looked_for"] = nlohmann::ordered_json::array();
    for (const devices::KnownDevice& known : devices::kKnownDevices)
        json["looked_for"].push_back({{"usb", numbersOf(known.model)},
                                      {"name", known.name},
                                      {"kind", word(known.kind)},
                                      {"driven", known.driven}});
    json["exit_code"] = exitCode(report);
    // What devices call themselves may be in any encoding.
    out << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void printDeviceList(std::ostream& out, const std::vector<Attached>& attached) {
    if (attached.empty()) {
        out << "No device is attached (illuminatedfocus doctor says what was looked for).\n";
        return;
    }
    for (const Attached& device : attached) {
        // Nothing was asked here, so a device that may be opened counts as there.
        const std::string state = device.state == Readiness::notAsked ? "ready" : word(device.state);
        out << std::left << std::setw(12) << word(device.kind) << std::setw(14) << state << std::setw(24) << device.name
            << ' ' << device.where;
        if (!device.node.empty() && device.node != device.where) out << ' ' << device.node;
        out << '\n';
    }
}

}  // namespace ilf::app
