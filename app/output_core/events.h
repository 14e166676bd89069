// Every event the output core writes into its log, by a number that never changes its meaning.
#pragma once

#include <string>

namespace ilf::app {

enum class Weight { info, warning, error };

/// A line of the log: "E-101 player started: process 4711". Numbers are for looking things up and for counting.
struct Event {
    int number;
    Weight weight;
    const char* sentence;
};

namespace event {

// 1xx: processes.
inline constexpr Event kCoreStarted{100, Weight::info, "output core started"};
inline constexpr Event kPlayerStarted{101, Weight::info, "player started"};
inline constexpr Event kPlayerDied{102, Weight::error, "player ended unexpectedly; safe light; it is started again"};
inline constexpr Event kPlayerStopped{103, Weight::info, "player stopped in safe light"};
inline constexpr Event kPlayerStuck{104, Weight::error, "player does not end in time and is killed"};
inline constexpr Event kPlayerHangs{105, Weight::error,
                                    "player's own thread hangs; it ends, so that another may begin"};
inline constexpr Event kPlayerTwice{106, Weight::error, "player not started: another one holds the stage"};
inline constexpr Event kNoProcess{107, Weight::error, "no process can be started"};
inline constexpr Event kCoreStopped{109, Weight::info, "output core stopped"};
inline constexpr Event kDevicesStarted{110, Weight::info, "devices' process started"};
inline constexpr Event kDevicesGone{111, Weight::error, "devices' process is gone; it is started again"};
inline constexpr Event kDevicesSilent{112, Weight::error, "devices' process does not answer"};
inline constexpr Event kDevicesSaid{113, Weight::info, "devices"};
inline constexpr Event kDevicesFailed{114, Weight::error, "devices' process failed"};
inline constexpr Event kRigChanged{115, Weight::warning,
                                   "emulated rig is another one now; player and guard begin anew"};
inline constexpr Event kGuardStarted{120, Weight::info, "white guard started"};
inline constexpr Event kGuardSaid{121, Weight::info, "white guard"};
inline constexpr Event kGuardFailed{122, Weight::error, "white guard failed"};
inline constexpr Event kGuardStopped{123, Weight::info, "white guard stopped; the display is released"};
inline constexpr Event kNobodyPlays{124, Weight::error, "player and supervisor are gone; the stage is made safe"};

// 2xx: light and lens.
inline constexpr Event kLightSlotted{201, Weight::info, "light is slotted"};
inline constexpr Event kLightSteady{202, Weight::info, "light is steady"};
inline constexpr Event kSafeLightAsked{203, Weight::info, "safe light was asked for"};
inline constexpr Event kFault{204, Weight::error, "fault; safe light"};
inline constexpr Event kMadeSafe{205, Weight::info, "stage made safe"};
inline constexpr Event kNotSafe{206, Weight::error, "stage could not be made safe"};
inline constexpr Event kCannotPlay{207, Weight::error, "this rig cannot be played"};
inline constexpr Event kStage{208, Weight::info, "stage"};
inline constexpr Event kTape{209, Weight::info, "tape of a device"};
inline constexpr Event kNoTape{210, Weight::warning, "no tape of a device"};

// 3xx: the link to studios.
inline constexpr Event kStudioConnected{301, Weight::info, "a studio connected"};
inline constexpr Event kBadMessage{302, Weight::warning, "message refused"};
inline constexpr Event kUpdateRefused{303, Weight::warning, "update refused"};
inline constexpr Event kNoSocket{304, Weight::error, "socket cannot be opened"};

// 4xx: the machine.
inline constexpr Event kNotAllowed{401, Weight::warning, "not allowed on this machine"};
inline constexpr Event kNoLogFile{402, Weight::warning, "no log file"};
inline constexpr Event kServiceManager{403, Weight::info, "service manager is told"};

}  // namespace event

/// Writes it into the log, with what there is to say beside it.
void note(const Event& event, const std::string& detail = {});

}  // namespace ilf::app
