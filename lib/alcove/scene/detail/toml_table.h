/// Strict reader for a TOML table: keys that are never read are errors.
#pragma once

#include "alcove/base/types.h"

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// Every reader returns an empty optional if the key is missing. If the value has the wrong type, it throws an
/// InputError with file, line and fix. Keeps a reference to the table.
class TomlTable {
  public:
    /// `path` is the prefix in the names of tables inside this table, such as `object` in `[[object.part]]`.
    TomlTable(const toml::table& table, std::string file, std::string name, std::string path = {});

    std::optional<double> number(std::string_view key);               ///< finite
    std::optional<double> positive(std::string_view key);             ///< finite, > 0
    std::optional<int> count(std::string_view key, int min, int max); ///< an integer in [min, max]
    std::optional<bool> flag(std::string_view key);
    std::optional<std::string> text(std::string_view key);
    /// The index of the value among `words`. \throw InputError listing the words.
    std::optional<std::size_t> word(std::string_view key, std::initializer_list<std::string_view> words);
    std::optional<Vec3d> vector(std::string_view key);    ///< three finite numbers
    std::optional<Vec3d> direction(std::string_view key); ///< of any length but 0
    /// Three numbers in [0, max], or one number for all three channels.
    std::optional<Vec3> color(std::string_view key, double max);
    std::optional<TomlTable> table(std::string_view key);
    /// The elements of an array of tables; empty if the key is missing.
    std::vector<TomlTable> tables(std::string_view key);
    /// The tables inside this table, with their names. Every key must be a table.
    std::vector<std::pair<std::string, TomlTable>> named_tables();

    const toml::table& raw() const { return table_; }
    bool has(std::string_view key) const { return table_.contains(key); }
    const std::string& name() const { return name_; }

    /// Checks that all keys were read. \throw InputError for the first key that was not, naming the closest known key.
    void check_all_read() const;

    /// Throws an InputError with the line of the key, or of the table if there is no such key. The message is the key,
    /// `between` and `what`.
    [[noreturn]] void fail(std::string_view key, const std::string& what, std::string_view between = " ") const;

  private:
    const toml::node* find(std::string_view key);
    std::string path_of(std::string_view key) const;

    const toml::table& table_;
    std::string file_, name_, path_;
    std::vector<std::string> known_; ///< keys that were read
};

}
