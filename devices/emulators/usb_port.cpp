#include "devices/emulators/usb_port.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <set>

namespace ilf::devices::emulators {

/// Forgets programs that have closed their file. umockdev tells nobody of it: its signal "client-vanished" is declared
/// and never sent (0.17.16).
void UsbPort::forgetClosed() {
    std::erase_if(clients,
                  [](const auto& entry) { return umockdev_ioctl_client_get_connected(entry.first.get()) == FALSE; });
}

/// umockdev (0.17.16) takes some programs that were killed for connected for ever. In real time a program that uses a
/// device asks at least once a second, so one that did not for longer is dead, and a kernel would have closed its file.
void UsbPort::takeFromSilent(const Client& wishing) {
    if (patience.count() == 0) return;
    constexpr std::chrono::seconds kSilent{3};
    const auto old = std::chrono::steady_clock::now() - kSilent;
    for (auto& [program, other] : clients) {
        if (&other == &wishing || !other.claimed || other.heard > old) continue;
        other.claimed = false;
        other.urbs.clear();
        other.asksUntil.reset();
        other.askedFor.reset();
    }
}

UsbPort::Fetched UsbPort::fetched(UMockdevIoctlClient* client) {
    constexpr int kLongest = 1 << 20;
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    Fetched made;
    switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_SUBMITURB: {
        made.data = resolved(arg, 0, sizeof(usbdevfs_urb));
        const int length = made.data ? as<usbdevfs_urb>(made.data).buffer_length : -1;
        if (length > 0 && length <= kLongest)
            made.buffer = resolved(made.data.get(), offsetof(usbdevfs_urb, buffer), std::size_t(length));
        made.whole = length == 0 || made.buffer;
        break;
    }
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
        made.data = resolved(arg, 0, sizeof(void*));
        made.whole = made.data != nullptr;
        break;
    default:
        break;
    }
    return made;
}

// Ioctls of usbdevfs; linux/usbdevice_fs.h and the kernel's documentation of it.
std::optional<Outcome> UsbPort::answer(UMockdevIoctlClient* client, Fetched fetched, bool& known) {
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    const bool asks = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
    if (gone && !asks) return Outcome{-1, ENODEV};
    auto entry = std::ranges::find_if(clients, [&](const auto& known_) { return known_.first.get() == client; });
    if (entry == clients.end()) {
        forgetClosed();
        entry = clients.emplace(clients.end(), Owned<UMockdevIoctlClient>(client), Client{});
        g_object_ref(client);
    }
    Client& program = entry->second;
    program.heard = std::chrono::steady_clock::now();
    switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
        const IoctlData capabilities = resolved(arg, 0, sizeof(std::uint32_t));
        as<std::uint32_t>(capabilities) = USBDEVFS_CAP_ZERO_PACKET;
        return Outcome{0, 0};
    }
    case USBDEVFS_CLAIMINTERFACE:
        return claim(program);
    case USBDEVFS_RELEASEINTERFACE:
        program.claimed = false;
        return Outcome{0, 0};
    case USBDEVFS_DISCONNECT_CLAIM:
        kernelDriver = false;
        return claim(program);
    case USBDEVFS_GETDRIVER: {
        if (!kernelDriver) return Outcome{-1, ENODATA};
        const IoctlData driver = resolved(arg, 0, sizeof(usbdevfs_getdriver));
        descriptors.kernelDriver.copy(as<usbdevfs_getdriver>(driver).driver, USBDEVFS_MAXDRIVERNAME);
        return Outcome{0, 0};
    }
    case USBDEVFS_IOCTL: {
        const IoctlData call = resolved(arg, 0, sizeof(usbdevfs_ioctl));
        const int code = as<usbdevfs_ioctl>(call).ioctl_code;
        const bool connects = code == int(USBDEVFS_CONNECT);
        if (!connects && code != int(USBDEVFS_DISCONNECT)) return Outcome{-1, ENOTTY};
        if (!connects && !kernelDriver) return Outcome{-1, ENODATA};
        kernelDriver = connects && !descriptors.kernelDriver.empty();
        return Outcome{0, 0};
    }
    case USBDEVFS_SUBMITURB:
        return submit(program, std::move(fetched));
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY: {
        if (!fetched.whole) return Outcome{-1, EFAULT};
        const Outcome reaped = reap(program, fetched.data);
        if (reaped.first == 0 || patience.count() == 0) return reaped;
        program.askedFor = std::move(fetched.data);
        program.asksUntil = std::chrono::steady_clock::now() + patience;
        onWaiting();
        return std::nullopt;
    }
    case USBDEVFS_DISCARDURB:
        return discard(program, *reinterpret_cast<void**>(arg->data));
    case USBDEVFS_CLEAR_HALT: {
        const IoctlData endpoint = resolved(arg, 0, sizeof(unsigned));
        device->clearHalt(static_cast<std::uint8_t>(as<unsigned>(endpoint)), now_ns());
        return Outcome{0, 0};
    }
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_RESET:
        return Outcome{0, 0};
    default:
        known = false;
        return Outcome{-1, ENOTTY};
    }
}

Outcome UsbPort::claim(Client& client) {
    forgetClosed();
    takeFromSilent(client);
    const bool taken = std::ranges::any_of(
        clients, [&](const auto& other) { return &other.second != &client && other.second.claimed; });
    if (taken || kernelDriver || busy) return {-1, EBUSY};
    client.claimed = true;
    return {0, 0};
}

Outcome UsbPort::submit(Client& client, Fetched fetched) {
    if (!fetched.whole) return {-1, fetched.data ? EINVAL : EFAULT};
    Urb urb;
    urb.data = std::move(fetched.data);
    urb.buffer = std::move(fetched.buffer);
    const int length = urb.fields().buffer_length;
    if (urb.fields().type == USBDEVFS_URB_TYPE_ISO) return {-1, EINVAL};
    if (urb.isControl() && length < 8) return {-1, EINVAL};
    if (!urb.isControl() && !client.claimed) return {-1, EINVAL};
    client.urbs.push_back(std::move(urb));
    ++*transfers;
    progress(client, now_ns());
    if (patience.count() > 0 && !client.urbs.empty() && !client.urbs.back().done) onWaiting();
    if (!gone) return {0, 0};
    client.urbs.pop_back();
    return {-1, ENODEV};
}

/// Of each endpoint the oldest transfer that is not done goes on as far as the device lets it.
void UsbPort::progress(Client& client, std::int64_t now) {
    std::set<unsigned> waiting;
    for (Urb& urb : client.urbs) {
        if (gone) return;  // pulled out by this very transfer, perhaps
        const unsigned endpoint = urb.isControl() ? 0U : urb.fields().endpoint;
        if (urb.done || waiting.contains(endpoint)) continue;
        progress(urb, now);
        if (!urb.done) waiting.insert(endpoint);
    }
}

void UsbPort::progress(Urb& urb, std::int64_t now) {
    const std::span<std::uint8_t> bytes = urb.bytes();
    const std::uint8_t endpoint = urb.fields().endpoint;
    UsbTransfer transfer;
    if (urb.isControl()) {
        const auto word = [&](std::size_t offset) {
            return static_cast<std::uint16_t>(bytes[offset] + 256U * bytes[offset + 1]);
        };
        const ControlSetup setup{bytes[0], bytes[1], word(2), word(4), word(6)};
        const auto data = bytes.subspan(8, std::min<std::size_t>(bytes.size() - 8, setup.length));
        transfer = controlTransfer(*device, descriptors, setup, data, now);
    } else if ((endpoint & 0x80U) != 0) {
        transfer = device->in(endpoint, bytes.subspan(urb.moved), now);
    } else {
        transfer = device->out(endpoint, bytes.subspan(urb.moved), now);
    }
    urb.moved += transfer.bytes;
    switch (transfer.answer) {
    case UsbAnswer::done:
        urb.finish(0);
        break;
    case UsbAnswer::stall:
        urb.finish(-EPIPE);
        break;
    case UsbAnswer::busy:
        break;
    case UsbAnswer::gone:
        leave();
        onGone(*this);
        break;
    }
}

Outcome UsbPort::reap(Client& client, const IoctlData& pointer) {
    progress(client, now_ns());
    // Also of a device that is gone. libusb is told so by poll() as well, which umockdev cannot; without it, it waits
    // for each transfer to come back.
    const auto done = std::ranges::find_if(client.urbs, &Urb::done);
    if (done == client.urbs.end()) return {-1, gone ? ENODEV : EAGAIN};
    umockdev_ioctl_data_set_ptr(pointer.get(), 0, done->data.get());
    client.urbs.erase(done);
    return {0, 0};
}

void UsbPort::leave() {
    gone = true;
    for (auto& [program, client] : clients) {
        for (Urb& urb : client.urbs)
            if (!urb.done) urb.finish(-ESHUTDOWN);
        if (client.asksUntil) client.asksUntil = std::chrono::steady_clock::time_point::min();
    }
}

void UsbPort::endTransfers() {
    for (auto& [program, client] : clients) {
        for (Urb& urb : client.urbs) {
            if (!urb.done) urb.finish(-ESHUTDOWN);
        }
    }
}

bool UsbPort::waits() const {
    return std::ranges::any_of(clients,
                               [](const auto& entry) { return entry.second.asksUntil || !entry.second.urbs.empty(); });
}

void UsbPort::goOn(std::int64_t now) {
    for (auto& [program, client] : clients) {
        progress(client, now);
        if (!client.asksUntil) continue;
        const Outcome reaped = reap(client, client.askedFor);
        if (reaped.first != 0 && std::chrono::steady_clock::now() < *client.asksUntil) continue;
        client.asksUntil.reset();
        client.askedFor.reset();
        umockdev_ioctl_client_complete(program.get(), reaped.first, reaped.second);
    }
}

Outcome UsbPort::discard(Client& client, const void* address) {
    for (Urb& urb : client.urbs) {
        if (urb.done || urb.data->client_addr != reinterpret_cast<gulong>(address)) continue;
        urb.finish(-ENOENT);
        return {0, 0};
    }
    return {-1, EINVAL};
}

}  // namespace ilf::devices::emulators
