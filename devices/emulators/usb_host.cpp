#include "devices/emulators/usb_host.h"

#include <dlfcn.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <set>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "devices/emulators/usb_port.h"
#include "devices/emulators/usb_sysfs.h"

namespace ilf::devices::emulators {

namespace {

// A program that asks for a transfer that is done asks again at once, for as long as it takes: to umockdev a device's
// file can always be read. So the answer waits a little. Longer, and the program's other threads, which umockdev keeps
// waiting meanwhile, would starve.
constexpr std::chrono::microseconds kPatience{300};

/// Preloaded, its ioctl comes before the C library's.
bool preloaded() {
    Dl_info info{};
    void* found = dlsym(RTLD_DEFAULT, "ioctl");
    return found != nullptr && dladdr(found, &info) != 0 && info.dli_fname != nullptr &&
           std::string_view(info.dli_fname).find("umockdev-preload") != std::string_view::npos;
}

}  // namespace

struct UsbHost::Impl {
    Clock clock;
    Owned<UMockdevTestbed> bed;
    std::string directory;
    std::recursive_mutex devices;  ///< the emulators, and what is known of ports
    std::mutex bedCalls;           ///< the test bed takes one call at a time
    std::list<std::unique_ptr<UsbPort>> ports;
    std::set<std::string> busy, hubs;
    struct Return {
        std::string path;
        EmulatedUsbDevice* device;
        std::int64_t at_ns;
    };
    std::vector<Return> returns;
    int nextNumber = 1;
    std::uint64_t transfers = 0;
    std::chrono::microseconds patience{0};
    std::condition_variable_any wake;
    bool roused = false;
    std::int64_t wentOnAt_ns = 0;
    std::jthread attendant;  ///< pulls cables that devices pull themselves; last, so that it ends first

    ~Impl();
    UsbPort* at(const std::string& path) const;
    Result<void> plug(const std::string& path, EmulatedUsbDevice& device);
    Result<void> add(UsbPort& port);
    void pull(UsbPort& port);
    std::vector<UsbPort*> goneAndNotPulled();
    void letGo(UsbPort& port);
    void attend(const std::stop_token& stop);
    void goOn();
    void rouse() {
        roused = true;
        wake.notify_all();
    }
};

UsbPort* UsbHost::Impl::at(const std::string& path) const {
    for (const auto& port : ports)
        if (port->path == path && !port->gone) return port.get();
    return nullptr;
}

Result<void> UsbHost::Impl::plug(const std::string& path, EmulatedUsbDevice& device) {
    if (!isUsbPath(path)) return fail(Fault::outOfRange, "\"" + path + "\" is no place on a USB bus such as 1-2.3.");
    const std::scoped_lock bedLock(bedCalls);
    // What pulled its own cable there may not have been taken out yet.
    for (UsbPort* left : goneAndNotPulled())
        if (left->path == path) pull(*left);
    auto port = std::make_unique<UsbPort>();
    port->lock = &devices;
    port->now_ns = clock;
    port->transfers = &transfers;
    port->patience = patience;
    port->onGone = [this](UsbPort& left) {
        if (const auto back = left.device->backOnBusAt(); back && *back > clock())
            returns.push_back({left.path, left.device, *back});
        rouse();
    };
    port->onWaiting = [this] { rouse(); };
    port->catchUp = [this] { goOn(); };
    port->path = path;
    port->device = &device;
    port->descriptors = device.descriptors();
    port->kernelDriver = !port->descriptors.kernelDriver.empty();
    UsbPort& added = *port;
    {
        const std::scoped_lock lock(devices);
        bool taken = at(path) != nullptr || hubs.contains(path);
        for (const std::string& hub : usbHubsOf(path))
            taken = taken || at(hub) != nullptr;
        if (taken) return fail(Fault::outOfRange, "Something is plugged in at USB " + path + " already.");
        port->busy = busy.contains(path);
        ports.push_back(std::move(port));
    }

    for (const std::string& hub : usbHubsOf(path)) {
        if (!hubs.insert(hub).second) continue;
        UsbPort shape;
        shape.path = hub;
        shape.sysfs = sysfsOf(hub);
        shape.descriptors = usbDescriptors({0x1D6B, 0x0002, 9, "", "Hub", "", {}});
        if (auto made = add(shape); !made) return made;
    }
    added.sysfs = sysfsOf(path);

    added.handler.reset(umockdev_ioctl_base_new());
    g_signal_connect(added.handler.get(), "handle-ioctl",
                     G_CALLBACK(+[](UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer data) -> gboolean {
                         auto& served = *static_cast<UsbPort*>(data);
                         bool known = true;
                         std::optional<Outcome> outcome;
                         auto fetched = UsbPort::fetched(client);
                         {
                             const std::scoped_lock lock(*served.lock);
                             served.catchUp();
                             outcome = served.answer(client, std::move(fetched), known);
                         }
                         if (!known) return FALSE;
                         if (outcome) umockdev_ioctl_client_complete(client, outcome->first, outcome->second);
                         return TRUE;
                     }),
                     &added);
    return add(added);
}

/// Makes the device known to programs: the handler first, so that opening works when they hear of it.
Result<void> UsbHost::Impl::add(UsbPort& port) {
    const int number = nextNumber++;
    port.node = usbNodeOf(port.path, number);
    GError* error = nullptr;
    const auto refused = [&](const std::string& what) {
        const std::string why = error != nullptr ? error->message : "for no given reason";
        g_clear_error(&error);
        port.gone = true;
        return fail(Fault::device, what + " at USB " + port.path + " failed: " + why + ".");
    };
    if (port.handler && umockdev_testbed_attach_ioctl(bed.get(), port.node.c_str(), port.handler.get(), &error) == 0)
        return refused("Emulating a device");

    const std::string text = sysfsText(port.path, number, port.descriptors);
    if (umockdev_testbed_add_from_string(bed.get(), text.c_str(), &error) == 0) return refused("Adding a device");
    port.added = true;
    return {};
}

/// Programs hear of it, then the node vanishes; whoever still holds it open reads "no device". With `bedCalls` held.
void UsbHost::Impl::pull(UsbPort& port) {
    {
        const std::scoped_lock lock(devices);
        if (port.pulled) return;
        port.pulled = true;
        port.pulledAt = std::chrono::steady_clock::now();
        port.leave();
        port.goOn(clock());  // whoever waits is told
        port.device->unplugged(clock());
    }
    const std::string path = "/sys" + port.sysfs;
    umockdev_testbed_uevent(bed.get(), path.c_str(), "remove");
    umockdev_testbed_remove_device(bed.get(), path.c_str());
}

std::vector<UsbPort*> UsbHost::Impl::goneAndNotPulled() {
    const std::scoped_lock lock(devices);
    std::vector<UsbPort*> found;
    for (const auto& port : ports)
        if (port->gone && !port->pulled && port->added) found.push_back(port.get());
    return found;
}

/// No program holds it any more: nothing reaches it from here on. With `bedCalls` held.
void UsbHost::Impl::letGo(UsbPort& port) {
    g_signal_handlers_disconnect_by_data(port.handler.get(), &port);
    umockdev_testbed_detach_ioctl(bed.get(), port.node.c_str(), nullptr);
}

void UsbHost::Impl::attend(const std::stop_token& stop) {
    std::unique_lock lock(devices);
    while (!stop.stop_requested()) {
        if (!goneAndNotPulled().empty()) {
            lock.unlock();
            {
                const std::scoped_lock bedLock(bedCalls);
                for (UsbPort* port : goneAndNotPulled())
                    pull(*port);
            }
            lock.lock();
            continue;
        }
        // A while after it was pulled, so that nobody is half-way through opening it.
        const auto old = std::chrono::steady_clock::now() - std::chrono::seconds(1);
        for (const auto& port : ports)
            if (port->pulled) port->forgetClosed();
        const auto left = std::ranges::find_if(
            ports, [&](const auto& port) { return port->pulled && port->clients.empty() && port->pulledAt < old; });
        if (left != ports.end()) {
            const std::unique_ptr<UsbPort> port = std::move(*left);
            ports.erase(left);
            lock.unlock();
            {
                const std::scoped_lock bedLock(bedCalls);
                letGo(*port);
            }
            lock.lock();
            continue;
        }
        const auto due = std::ranges::find_if(returns, [&](const Return& r) { return r.at_ns <= clock(); });
        if (due != returns.end()) {
            const Return back = *due;
            returns.erase(due);
            lock.unlock();
            // Refused where somebody has plugged something in there meanwhile; that is then what is there.
            (void)plug(back.path, *back.device);
            lock.lock();
            continue;
        }
        goOn();
        const bool waits =
            patience.count() > 0 && std::ranges::any_of(ports, [](const auto& port) { return port->waits(); });
        const std::chrono::milliseconds pause(waits ? 1 : !returns.empty() ? 20 : 200);
        wake.wait_for(lock, stop, pause, [this] { return std::exchange(roused, false); });
    }
}

/// The bus, brought to now. Where this process was late, in steps, so that a device takes what was handed in for it
/// when it needed it.
void UsbHost::Impl::goOn() {
    if (patience.count() == 0) return;
    constexpr std::int64_t kStep_ns = 5'000'000, kLongest_ns = 2'000'000'000;
    const std::int64_t now = clock();
    std::int64_t time = std::max(wentOnAt_ns, now - kLongest_ns);
    do {
        time = std::min(time + kStep_ns, now);
        for (const auto& port : ports)
            if (port->handler) port->goOn(time);
    } while (time < now);
    wentOnAt_ns = now;
}

UsbHost::Impl::~Impl() {
    attendant = {};  // asked to stop, and waited for
    for (const auto& port : ports) {
        if (port->added) pull(*port);
        if (port->handler) letGo(*port);
    }
}

Result<std::unique_ptr<UsbHost>> UsbHost::started(Clock clock) {
    if (!preloaded())
        return fail(Fault::notFound, std::string("Emulated USB devices need ") + kUsbPreload +
                                         " (package umockdev) in LD_PRELOAD when the program starts.");
    auto impl = std::make_unique<Impl>();
    impl->clock = std::move(clock);
    if (!impl->clock) {
        impl->patience = kPatience;
        impl->clock = [] {
            return std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::steady_clock::now().time_since_epoch())
                .count();
        };
    }
    impl->bed.reset(umockdev_testbed_new());
    gchar* root = umockdev_testbed_get_root_dir(impl->bed.get());
    impl->directory = root;
    g_free(root);
    Impl& attended = *impl;
    impl->attendant = std::jthread([&attended](const std::stop_token& stop) { attended.attend(stop); });
    return std::unique_ptr<UsbHost>(new UsbHost(std::move(impl)));
}

UsbHost::UsbHost(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UsbHost::~UsbHost() = default;

Result<void> UsbHost::plug(const std::string& path, EmulatedUsbDevice& device) { return impl_->plug(path, device); }

void UsbHost::unplug(const std::string& path) {
    const std::scoped_lock bedLock(impl_->bedCalls);
    // What has left by itself is let go of now: its device may be gone once this returns.
    for (UsbPort* left : impl_->goneAndNotPulled())
        impl_->pull(*left);
    UsbPort* port = nullptr;
    {
        const std::scoped_lock lock(impl_->devices);
        std::erase_if(impl_->returns, [&](const Impl::Return& back) { return back.path == path; });
        port = impl_->at(path);
    }
    if (port != nullptr) impl_->pull(*port);
}

bool UsbHost::plugged(const std::string& path) const {
    const std::scoped_lock lock(impl_->devices);
    return impl_->at(path) != nullptr;
}

void UsbHost::setBusy(const std::string& path, bool busy) {
    const std::scoped_lock lock(impl_->devices);
    if (busy)
        impl_->busy.insert(path);
    else
        impl_->busy.erase(path);
    if (UsbPort* port = impl_->at(path)) port->busy = busy;
}

void UsbHost::locked(const std::function<void(std::int64_t now_ns)>& work) {
    const std::scoped_lock lock(impl_->devices);
    impl_->goOn();
    work(impl_->clock());
}

std::int64_t UsbHost::now_ns() const { return impl_->clock(); }
const std::string& UsbHost::directory() const { return impl_->directory; }
std::uint64_t UsbHost::transfers() const {
    const std::scoped_lock lock(impl_->devices);
    return impl_->transfers;
}

}  // namespace ilf::devices::emulators
