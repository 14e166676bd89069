// A connection to the X server whose loss, like a request that is refused, does not end the process.
#pragma once

#include <atomic>
#include <memory>

#include "core/base/result.h"

// Xlib's Display. Its headers define macros that other headers cannot live with.
struct _XDisplay;  // NOLINT(bugprone-reserved-identifier)

namespace ilf::devices {

using XServerConnection = _XDisplay;  // NOLINT(bugprone-reserved-identifier)

/// Xlib ends the process when the server is gone or refuses a request; through this class both are states that can be
/// asked for. After `lost` no more requests should be made: they do nothing, and fill a buffer that nobody empties.
class XConnection {
public:
    /// To the server that DISPLAY names.
    static Result<std::unique_ptr<XConnection>> open();
    ~XConnection();
    XConnection(const XConnection&) = delete;
    XConnection& operator=(const XConnection&) = delete;

    XServerConnection* get() const { return display_; }
    unsigned long root() const;
    int descriptor() const;
    bool lost() const { return lost_; }
    /// Waits for the server to have done all that was asked of it. False: it is gone, or refused something since the
    /// last time this was asked.
    bool accepted();

    void refused() { refused_ = true; }  ///< for the error handlers
    void gone() { lost_ = true; }

private:
    explicit XConnection(XServerConnection* display);

    XServerConnection* display_;
    std::atomic<bool> lost_{false}, refused_{false};
};

}  // namespace ilf::devices
