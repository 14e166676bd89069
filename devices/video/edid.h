// Who a display says it is: maker, model and serial number from its EDID.
#pragma once

#include <cstdint>
#include <span>

#include "core/document/rig_devices.h"

namespace ilf::devices {

/// Maker as its three letters ("TXN"), model as its name descriptor or else its product code ("0x4500"), serial as its
/// text descriptor or else its number; each empty where the EDID has none. All empty for bytes that are no EDID (wrong
/// header, too short, wrong checksum of the first block). The connector is left empty.
/// Source: VESA E-EDID standard, release A2, section 3.
DisplayIdentity identityFromEdid(std::span<const std::uint8_t> edid);

}  // namespace ilf::devices
