// An immutable value that is shared instead of copied.
#pragma once

#include <memory>
#include <utility>

namespace ilf {

/// Copying a Box copies a pointer; the value inside can never change, so two boxes that point to the same value are
/// equal without looking, and a box can be read from any thread. A default box is empty (`if (box)`).
template <class T>
class Box {
public:
    Box() = default;
    explicit Box(T value) : value_(std::make_shared<const T>(std::move(value))) {}
    /// Takes over a value that nobody else will change any more.
    explicit Box(std::shared_ptr<const T> value) : value_(std::move(value)) {}

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    explicit operator bool() const { return value_ != nullptr; }
    /// The same box, not merely the same content: what tells incremental code that nothing changed.
    bool same(const Box& other) const { return value_ == other.value_; }

    bool operator==(const Box& other) const {
        return same(other) || (value_ && other.value_ && *value_ == *other.value_);
    }

private:
    std::shared_ptr<const T> value_;
};

}  // namespace ilf
