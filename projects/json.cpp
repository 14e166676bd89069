#include "projects/json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace ilf::projects {

using Node = nlohmann::ordered_json;

struct Json::Value {
    Node node = Node::object();
};

namespace {

const Node* member(const Node& node, const char* key) {
    const auto found = node.find(key);
    return found == node.end() || found->is_null() ? nullptr : &*found;
}

}  // namespace

Json::Json() : value_(std::make_shared<Value>()) {}

Result<Json> Json::parse(std::string_view text, const std::string& file) {
    Json json;
    try {
        json.own().node = Node::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        const std::string_view before = text.substr(0, std::min(text.size(), error.byte > 0 ? error.byte - 1 : 0));
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        const std::size_t lineStart = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
        return fail(Fault::badFile, file + " is damaged at line " + std::to_string(line) + ", column " +
                                        std::to_string(before.size() - lineStart + 1) +
                                        ". Repair it there, or take a backup.");
    } catch (const std::exception&) {
        return fail(Fault::badFile,
                    file + " is damaged: it holds a number or text that cannot be read. Take a backup.");
    }
    if (!json.value_->node.is_object()) {
        return fail(Fault::badFile, file + " is damaged: it must hold one object in braces. Take a backup.");
    }
    return json;
}

std::string Json::text() const { return value_->node.dump(2, ' ', false, Node::error_handler_t::replace) + "\n"; }

Json Json::object(const char* key) const {
    Json json;
    const Node* found = member(value_->node, key);
    if (found != nullptr && found->is_object()) json.own().node = *found;
    return json;
}

std::vector<Json> Json::objects(const char* key) const {
    std::vector<Json> list;
    const Node* found = member(value_->node, key);
    if (found == nullptr || !found->is_array()) return list;
    for (const Node& item : *found) {
        list.emplace_back();
        if (item.is_object()) list.back().own().node = item;
    }
    return list;
}

std::string Json::word(const char* key) const {
    const Node* found = member(value_->node, key);
    return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

Json::Value& Json::own() {
    if (value_.use_count() > 1) value_ = std::make_shared<Value>(*value_);
    return *value_;
}

void Json::set(const char* key, double value) { own().node[key] = value; }
void Json::set(const char* key, int value) { own().node[key] = value; }
void Json::set(const char* key, bool value) { own().node[key] = value; }
void Json::set(const char* key, const std::string& value) { own().node[key] = value; }
void Json::set(const char* key, const Json& value) { own().node[key] = value.value_->node; }
void Json::set(const char* key, const std::vector<Json>& values) {
    Node list = Node::array();
    for (const Json& value : values)
        list.push_back(value.value_->node);
    own().node[key] = std::move(list);
}
void Json::set(const char* key, const std::vector<double>& values) { own().node[key] = values; }
void Json::setPairs(const char* key, const std::vector<std::pair<double, double>>& values) {
    Node list = Node::array();
    for (const auto& [first, second] : values)
        list.push_back(Node::array({first, second}));
    own().node[key] = std::move(list);
}
void Json::erase(const char* key) {
    if (value_->node.contains(key)) own().node.erase(key);
}

JsonReader::JsonReader(Json json, std::string file)
    : JsonReader(std::move(json), std::move(file), "", std::make_shared<std::optional<Error>>()) {}

JsonReader::JsonReader(Json json, std::string file, std::string path, std::shared_ptr<std::optional<Error>> problem)
    : json_(std::move(json)), file_(std::move(file)), path_(std::move(path)), problem_(std::move(problem)) {}

void JsonReader::complain(const char* key, const std::string& what) {
    if (!*problem_) *problem_ = Error{Fault::badFile, file_ + ": " + path_ + key + " " + what};
}

bool JsonReader::has(const char* key) const { return member(json_.value_->node, key) != nullptr; }

double JsonReader::number(const char* key) {
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr || !found->is_number()) {
        complain(key, found == nullptr ? "is missing." : "must be a number.");
        return 0.0;
    }
    return found->get<double>();
}
double JsonReader::number(const char* key, double otherwise) { return has(key) ? number(key) : otherwise; }
std::optional<double> JsonReader::optionalNumber(const char* key) {
    if (!has(key)) return std::nullopt;
    return number(key);
}

int JsonReader::whole(const char* key) {
    const double value = number(key);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
        complain(key, "must be a whole number.");
        return 0;
    }
    return static_cast<int>(value);
}

bool JsonReader::flag(const char* key, bool otherwise) {
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr) return otherwise;
    if (!found->is_boolean()) {
        complain(key, "must be true or false.");
        return otherwise;
    }
    return found->get<bool>();
}

std::string JsonReader::word(const char* key) {
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr || !found->is_string()) {
        complain(key, found == nullptr ? "is missing." : "must be text in quotes.");
        return {};
    }
    return found->get<std::string>();
}
std::string JsonReader::word(const char* key, const std::string& otherwise) { return has(key) ? word(key) : otherwise; }

std::size_t JsonReader::choice(const char* key, const std::vector<std::string>& words) {
    const std::string given = word(key);
    const auto found = std::find(words.begin(), words.end(), given);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    std::string list;
    for (const std::string& one : words)
        list += (list.empty() ? "" : one == words.back() ? " or " : ", ") + one;
    complain(key, "must be " + list + ", but is \"" + given + "\".");
    return 0;
}

JsonReader JsonReader::object(const char* key) {
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr || !found->is_object()) {
        complain(key, found == nullptr ? "is missing." : "must be an object in braces.");
    }
    return {json_.object(key), file_, path_ + key + ".", problem_};
}

std::vector<JsonReader> JsonReader::objects(const char* key) {
    std::vector<JsonReader> list;
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr) return list;
    const bool well =
        found->is_array() && std::all_of(found->begin(), found->end(), [](const Node& n) { return n.is_object(); });
    if (!well) {
        complain(key, "must be a list of objects.");
        return list;
    }
    const std::vector<Json> items = json_.objects(key);
    for (std::size_t i = 0; i < items.size(); ++i) {
        list.push_back(JsonReader(items[i], file_, path_ + key + "[" + std::to_string(i) + "].", problem_));
    }
    return list;
}

std::vector<double> JsonReader::numbers(const char* key, std::size_t count) {
    const Node* found = member(json_.value_->node, key);
    const bool well = found != nullptr && found->is_array() && found->size() == count &&
                      std::all_of(found->begin(), found->end(), [](const Node& n) { return n.is_number(); });
    if (well) return found->get<std::vector<double>>();
    complain(key, "must be a list of " + std::to_string(count) + " numbers.");
    return std::vector<double>(count, 0.0);
}

std::vector<std::pair<double, double>> JsonReader::pairs(const char* key) {
    std::vector<std::pair<double, double>> list;
    const Node* found = member(json_.value_->node, key);
    if (found == nullptr) return list;
    const auto isPair = [](const Node& n) {
        return n.is_array() && n.size() == 2 && n[0].is_number() && n[1].is_number();
    };
    if (!found->is_array() || !std::all_of(found->begin(), found->end(), isPair)) {
        complain(key, "must be a list of pairs of numbers.");
        return list;
    }
    for (const Node& n : *found)
        list.emplace_back(n[0].get<double>(), n[1].get<double>());
    return list;
}

Result<void> checkedFormat(const Json& json, const std::string& file, const std::string& format, int version,
                           const std::string& thing) {
    if (json.word("format") != format) {
        return fail(Fault::badFile, file + " is not a " + thing + " of this program.");
    }
    JsonReader reader(json, file);
    const int found = reader.whole("version");
    if (!reader.problem() && found < 1) reader.complain("version", "must be 1 or more.");
    if (reader.problem()) return tl::unexpected(*reader.problem());
    if (found > version) {
        return fail(Fault::unsupported, "This " + thing + " was written by a newer version (format " +
                                            std::to_string(found) + "). Update, or ask for it to be saved as format " +
                                            std::to_string(version) + ".");
    }
    return {};
}

}  // namespace ilf::projects
