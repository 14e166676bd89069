#include "projects/gltf/checker.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace ilf::projects::gltf {

using Json = nlohmann::json;

std::optional<std::int64_t> wholeOf(const Json& value) {
    constexpr double kExact = 9007199254740992.0;
    if (!value.is_number()) return std::nullopt;
    const double number = value.get<double>();
    if (!(std::abs(number) <= kExact) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::int64_t>(number);
}

std::size_t countOf(const Json& root, const char* name) {
    const auto found = root.find(name);
    return found != root.end() && found->is_array() ? found->size() : 0;
}

bool Checked::has(const char* member) const { return value_->contains(member); }

const Json* Checked::find(const char* member, Need need) const {
    const auto found = value_->find(member);
    if (found != value_->end()) return &*found;
    if (need == Need::required) refuse(member, "is missing");
    return nullptr;
}

std::optional<Checked> Checked::object(const char* member, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    if (!found->is_object()) {
        refuse(member, "must be an object");
        return std::nullopt;
    }
    return Checked(*found, where_.empty() ? member : where_ + "." + member, *root_, *findings_);
}

std::size_t Checked::listed(const char* member, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return 0;
    if (!found->is_array()) {
        refuse(member, "must be a list");
        return 0;
    }
    if (found->empty()) refuse(member, "is an empty list, which glTF does not allow");
    return found->size();
}

std::optional<Checked> Checked::element(const char* member, std::size_t i) const {
    const Json& value = (*value_)[member][i];
    const std::string name = (where_.empty() ? member : where_ + "." + member) + "[" + std::to_string(i) + "]";
    if (!value.is_object()) {
        findings_->refuse(name, "must be an object");
        return std::nullopt;
    }
    return Checked(value, name, *root_, *findings_);
}

std::optional<std::int64_t> Checked::whole(const char* member, std::int64_t least, std::int64_t most, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    const auto number = wholeOf(*found);
    if (!number) {
        refuse(member, "must be a whole number");
        return std::nullopt;
    }
    if (*number < least || *number > most) {
        refuse(member, "is " + std::to_string(*number) + ", where " + std::to_string(least) + " to " +
                           std::to_string(most) + " can be read");
        return std::nullopt;
    }
    return number;
}

std::optional<std::int64_t> Checked::oneOf(const char* member, std::initializer_list<std::int64_t> values,
                                           Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    const auto number = wholeOf(*found);
    for (const std::int64_t value : values) {
        if (number == value) return number;
    }
    refuse(member, "is no code that glTF knows");
    return std::nullopt;
}

std::optional<double> Checked::number(const char* member, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    if (!found->is_number() || !std::isfinite(found->get<double>())) {
        refuse(member, "must be a number");
        return std::nullopt;
    }
    return found->get<double>();
}

std::optional<bool> Checked::flag(const char* member) const {
    const Json* found = find(member, Need::optional);
    if (found == nullptr) return std::nullopt;
    if (!found->is_boolean()) {
        refuse(member, "must be true or false");
        return std::nullopt;
    }
    return found->get<bool>();
}

std::optional<std::string> Checked::text(const char* member, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    if (!found->is_string()) {
        refuse(member, "must be a text");
        return std::nullopt;
    }
    return found->get<std::string>();
}

void Checked::numbers(const char* member, std::size_t count) const {
    const Json* found = find(member, Need::optional);
    if (found == nullptr) return;
    bool good = found->is_array() && !found->empty() && (count == 0 || found->size() == count);
    if (good) {
        for (const Json& one : *found)
            good = good && one.is_number() && std::isfinite(one.get<double>());
    }
    if (!good) refuse(member, "must be " + (count == 0 ? "" : std::to_string(count) + " ") + "numbers");
}

std::optional<std::size_t> Checked::reference(const char* member, const char* target, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return std::nullopt;
    const auto index = wholeOf(*found);
    const std::size_t count = countOf(*root_, target);
    if (!index || *index < 0) {
        refuse(member, std::string("must be an index into ") + target);
        return std::nullopt;
    }
    if (static_cast<std::size_t>(*index) >= count) {
        refuse(member, "points at " + std::string(target) + "[" + std::to_string(*index) + "], but there are " +
                           std::to_string(count));
        return std::nullopt;
    }
    return static_cast<std::size_t>(*index);
}

void Checked::references(const char* member, const char* target, Need need) const {
    const Json* found = find(member, need);
    if (found == nullptr) return;
    if (!found->is_array() || found->empty()) {
        refuse(member, found->is_array() ? "is an empty list, which glTF does not allow" : "must be a list");
        return;
    }
    const std::size_t count = countOf(*root_, target);
    std::set<std::int64_t> seen;
    for (std::size_t i = 0; i < found->size(); ++i) {
        const auto index = wholeOf((*found)[i]);
        const std::string name = std::string(member) + "[" + std::to_string(i) + "]";
        if (!index || *index < 0) {
            refuse(name, std::string("must be an index into ") + target);
        } else if (static_cast<std::size_t>(*index) >= count) {
            refuse(name, "points at " + std::string(target) + "[" + std::to_string(*index) + "], but there are " +
                             std::to_string(count));
        } else if (!seen.insert(*index).second) {
            refuse(name, "names " + std::string(target) + "[" + std::to_string(*index) + "] twice");
        }
    }
}

}  // namespace ilf::projects::gltf
