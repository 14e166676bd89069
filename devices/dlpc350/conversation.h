// Questions and orders to one DLPC350, one at a time, each with its own answer or an error.
#pragma once

#include <memory>
#include <string>

#include "devices/dlpc350/settings.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices::dlpc350 {

/// Answers are matched by sequence number; older ones are thrown away, and after anything that went wrong whatever
/// still lies in the board is drained before the next message. Silence is an error (TI's own code takes it for
/// success).
class Conversation {
public:
    static Result<Conversation> over(std::unique_ptr<UsbLink> link);

    /// "The LightCrafter 4500 at 1-2": how sentences start.
    const std::string& name() const { return name_; }
    const UsbIdentity& identity() const { return link_->identity(); }
    /// How long each message may take, and each packet of an answer; TI's own 2 s until it is told.
    void setLimit(Milliseconds limit) { limit_ = limit; }

    /// Sends `payload` and waits until the board acknowledges it.
    Result<void> tell(Command command, Data payload);
    /// The data of the board's reply.
    Result<Bytes> ask(Command command);
    template <class T>
    Result<T> ask() {
        const auto data = ask(kCommandOf<T>);
        if (!data) return tl::unexpected(data.error());
        return parsed<T>(*data).map_error([&](const Error& error) { return about(error); });
    }

private:
    Conversation(std::unique_ptr<UsbLink> link, Endpoint out, Endpoint in);
    Result<Reply> replyTo(Command command, bool isRead);
    Result<Reply> nextReply(Command command, bool isRead);
    Result<void> sent(Command command, std::span<const Packet> packets);
    void drained();
    Error about(const Error& error) const;
    tl::unexpected<Error> silent(Command command, const Error& why);

    std::unique_ptr<UsbLink> link_;
    Endpoint out_, in_;
    std::string name_;
    std::uint8_t sequence_ = 0;
    Milliseconds limit_{2000};  ///< TI's own read time-out
    bool mayBeHalted_ = false;  ///< a transfer failed: an endpoint that stalled stays so until it is told
    bool unsettled_ = true;     ///< an answer of an earlier message, or of an earlier program, may still come
};

}  // namespace ilf::devices::dlpc350
