// A serial port of the machine, or a pseudo-terminal, through termios.
#pragma once

#include <memory>
#include <string>

#include "devices/serial/serial_link.h"

namespace ilf::devices {

/// Opens `path` raw at 115200 baud, 8N1, without flow control and without hanging up when it is closed (some boards
/// restart when DTR falls). Asks to be its only user: where the kernel refuses that (umockdev) it is opened all the
/// same. Bytes that waited in the port are thrown away.
/// Errors: `notFound` (no such port), `device` (permission, in use, not a terminal), with what to do about it.
Result<std::unique_ptr<SerialLink>> openSerialPort(const std::string& path);

}  // namespace ilf::devices
