// Reading of glTF's JSON that notes everything wrong: required members, kinds, ranges and references.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

#include "projects/gltf/findings.h"

namespace ilf::projects::gltf {

/// One JSON value of the file and where it stands. Findings outlive it.
class Checked {
public:
    enum class Need { optional, required };

    Checked(const nlohmann::json& value, std::string where, const nlohmann::json& root, Findings& findings)
        : value_(&value), root_(&root), where_(std::move(where)), findings_(&findings) {}

    const nlohmann::json& json() const { return *value_; }
    const std::string& where() const { return where_; }
    void refuse(const std::string& what) const { findings_->refuse(where_, what); }
    void refuse(const std::string& member, const std::string& what) const {
        findings_->refuse(where_.empty() ? member : where_ + "." + member, what);
    }
    bool has(const char* member) const;

    /// The member object; nothing where it is missing or none (which is then noted).
    std::optional<Checked> object(const char* member, Need need = Need::optional) const;
    /// Calls `visit` with each element of the member list. A list must not be empty; its elements must be objects.
    template <class Visit>
    void each(const char* member, Need need, Visit visit) const {
        const std::size_t count = listed(member, need);
        for (std::size_t i = 0; i < count; ++i) {
            if (const auto one = element(member, i)) visit(*one, i);
        }
    }
    /// A whole number in a range; integers written as 3.0 are good.
    std::optional<std::int64_t> whole(const char* member, std::int64_t least, std::int64_t most,
                                      Need need = Need::optional) const;
    std::optional<std::int64_t> oneOf(const char* member, std::initializer_list<std::int64_t> values,
                                      Need need = Need::optional) const;
    std::optional<double> number(const char* member, Need need = Need::optional) const;
    std::optional<bool> flag(const char* member) const;
    std::optional<std::string> text(const char* member, Need need = Need::optional) const;
    /// `count` numbers; 0: any count.
    void numbers(const char* member, std::size_t count) const;
    /// An index into the file's list `target`.
    std::optional<std::size_t> reference(const char* member, const char* target, Need need = Need::optional) const;
    /// A list of different indices into the file's list `target`.
    void references(const char* member, const char* target, Need need = Need::optional) const;

private:
    std::size_t listed(const char* member, Need need) const;
    std::optional<Checked> element(const char* member, std::size_t i) const;
    const nlohmann::json* find(const char* member, Need need) const;

    const nlohmann::json* value_;
    const nlohmann::json* root_;
    std::string where_;
    Findings* findings_;
};

/// The number as a whole one, if it is; never beyond 2^53.
std::optional<std::int64_t> wholeOf(const nlohmann::json& value);

/// How many objects the file's list `name` has.
std::size_t countOf(const nlohmann::json& root, const char* name);

}  // namespace ilf::projects::gltf
