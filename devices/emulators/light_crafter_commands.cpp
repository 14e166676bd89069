#include "devices/emulators/light_crafter_commands.h"

namespace ilf::devices::emulators {

const std::map<unsigned, Command>& commands() {
    static const std::map<unsigned, Command> table = {
        {0x0205, {kNo, 16}},
        {0x1AFF, {kNo, 32}},
        {0x0200, {1, 1}},
        {0x0802, {0, kNo}},
        {0x1A0A, {kNo, 1}},
        {0x1A0B, {kNo, 1}},
        {0x1A0C, {kNo, 1}},
        {0x071C, {kNo, 28}},
        {0x1A00, {1, 1, true, {0x08}}},
        {0x1A02, {1, 1, true}},
        {0x1A03, {1, 1, true}},
        {0x1A37, {1, 1, true, {0x04}}},
        {0x1A04, {1, 1, true}},
        {0x1000, {16, 16}},
        {0x1008, {1, 1}},
        {0x1009, {1, 1}},
        {0x1203, {1, 1}},
        {0x1204, {12, 12}},
        {0x1100, {6, 6}},
        {0x100A, {1, 1, false, {1}}},
        {0x1A26, {1, kNo}},
        {0x1A27, {1, 1}},
        {0x1A28, {1, 1}},
        {0x1A1B, {1, 1, true}},
        {0x1A22, {1, 1, true, {3}}},
        {0x1A23, {1, 1, true, {1}}},
        {0x1A24, {1, 1}},
        {0x1A29, {8, 8, true}},
        {0x1A30, {1, 1, true}},
        {0x1A31, {4, 4, true}},
        {0x1A33, {1, 1, true}},
        {0x1A32, {1, 1, true}},
        {0x1A34, {kAny, kAny, true}},
        {0x1A3E, {12, kNo, true}},
        {0x1A3F, {2, 2, true}},
        {0x1A40, {6, 6, true}},
        {0x1A1A, {1, 1, true}},
        {0x1A1D, {3, 3, false, {0, 0xBB, 0xBB}}},
        {0x1A1E, {2, 2, false, {0, 0xBB}}},
        {0x1A35, {4, 4}},
        {0x1A36, {1, 1}},
        {0x1A1F, {2, 2, false, {0xBB, 0xBB}}},
        {0x1A20, {2, 2, false, {0xBB, 0xBB}}},
        {0x1A21, {2, 2, false, {0xBB, 0xBB}}},
        {0x1A07, {1, 1, false, {0x08}}},
        {0x0B01, {3, 3, false, {0x68, 0x87, 0x82}}},
        {0x1A05, {1, 1}},
        {0x1A0E, {1, 1, false, {0x80}}},
        {0x0609, {1, 1}},
        {0x1A39, {1, 1}},
        {0x1A3A, {kNo, 4}},
        {0x1A42, {kNo, 1}},
    };
    return table;
}

bool forbidden(unsigned command) { return command == 0x3001 || command >> 8U == 0; }

bool allowed(unsigned command, std::span<const std::uint8_t> payload) {
    switch (command) {
    case 0x0200:
    case 0x1A1B:
        return payload[0] <= 1;
    case 0x1A00:
        return (payload[0] & 7U) <= 3;
    case 0x1A22:
        return payload[0] == 0 || payload[0] == 3;
    case 0x1A23:
        return payload[0] <= 4;
    case 0x1A24:
        return payload[0] <= 2;
    case 0x1A31:
        return payload[0] <= 127 && payload[1] <= 1;
    case 0x1A32:
        return payload[0] <= 127;
    case 0x1A33:
        return payload[0] <= 3;
    case 0x1203:
        return payload[0] <= 0x0A;
    default:
        return true;
    }
}

}  // namespace ilf::devices::emulators
