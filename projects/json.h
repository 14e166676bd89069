// JSON objects as values, and a reader that remembers the first thing wrong and where.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace ilf::projects {

/// A JSON value; cheap to copy. Objects keep the order of their keys and the keys nobody knows.
class Json {
public:
    Json();  ///< an empty object
    /// Refused with line and column where the text is damaged, and when it is not an object.
    static Result<Json> parse(std::string_view text, const std::string& file);
    /// Indented by two spaces, numbers in their shortest exact form.
    std::string text() const;

    /// The member object, or an empty object; the member list's objects, or none.
    Json object(const char* key) const;
    std::vector<Json> objects(const char* key) const;
    /// The member's text, or "" where it is none.
    std::string word(const char* key) const;

    void set(const char* key, double value);
    void set(const char* key, int value);
    void set(const char* key, bool value);
    void set(const char* key, const std::string& value);
    void set(const char* key, const Json& value);
    void set(const char* key, const std::vector<Json>& values);
    void set(const char* key, const std::vector<double>& values);
    /// A list of lists of two numbers.
    void setPairs(const char* key, const std::vector<std::pair<double, double>>& values);
    void erase(const char* key);

private:
    friend class JsonReader;
    struct Value;
    Value& own();  ///< the value for changing: shared until then
    std::shared_ptr<Value> value_;
};

/// Reads members of an object. A member that is missing or of the wrong kind gives a neutral value, and the reading as
/// a whole fails with one sentence that names the first of them, as in
/// `"project.json": regions[2].distance.value_m must be a number`.
class JsonReader {
public:
    JsonReader(Json json, std::string file);

    bool has(const char* key) const;
    double number(const char* key);
    double number(const char* key, double otherwise);
    std::optional<double> optionalNumber(const char* key);
    int whole(const char* key);
    bool flag(const char* key, bool otherwise);
    std::string word(const char* key);
    std::string word(const char* key, const std::string& otherwise);
    /// One of `words`, as its index.
    std::size_t choice(const char* key, const std::vector<std::string>& words);
    JsonReader object(const char* key);
    std::vector<JsonReader> objects(const char* key);
    std::vector<double> numbers(const char* key, std::size_t count);
    std::vector<std::pair<double, double>> pairs(const char* key);

    /// Says what is wrong with a member, if nothing was wrong before.
    void complain(const char* key, const std::string& what);
    const std::optional<Error>& problem() const { return *problem_; }
    const Json& json() const { return json_; }

private:
    JsonReader(Json json, std::string file, std::string path, std::shared_ptr<std::optional<Error>> problem);
    Json json_;
    std::string file_, path_;
    std::shared_ptr<std::optional<Error>> problem_;
};

/// Checks "format" and "version" of a file of ours: another format and a newer version are refused in words. `thing` is
/// what it is called, "project" or "wearer file".
Result<void> checkedFormat(const Json& json, const std::string& file, const std::string& format, int version,
                           const std::string& thing);

}  // namespace ilf::projects
