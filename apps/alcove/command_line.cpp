#include "command_line.h"

#include "alcove/base/detail/edit_distance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace alcove::cli {
namespace {

std::string guess(std::string_view typed, const std::vector<std::string>& names) {
    const std::string meant = nearest_name(typed, names);
    return meant.empty() ? meant : fmt::format(" (did you mean {}?)", meant);
}

std::vector<std::string> verbs_of(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(verb->get_name());
    return names;
}

std::vector<std::string> options_of(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    return names;
}

bool is_option(const std::string& word) {
    return word.size() > 1 && word[0] == '-';
}

std::string explain_verb(const CLI::App& program, const std::vector<std::string>& words) {
    const std::vector<std::string> verbs = verbs_of(program);
    const auto typed = std::find_if_not(words.begin(), words.end(), is_option);
    if (typed != words.end())
        return fmt::format("there is no verb '{}'{}; the verbs are: {}", *typed, guess(*typed, verbs),
                           fmt::join(verbs, ", "));
    if (!words.empty())
        return fmt::format("{} is not an option of alcove itself; name a verb: {}", words.front(),
                           fmt::join(verbs, ", "));
    return fmt::format("a verb is needed: {}", fmt::join(verbs, ", "));
}

/// Rephrases a message of CLI11 such as "Could not convert: --threads = -1".
std::string explain_conversion(const CLI::App& verb, const std::string& said) {
    // The values that options take, by the name of the option or by the name of its type.
    static const std::map<std::string, std::string> kinds{{"--seed", "a whole number from 0 to 4294967295"},
                                                          {"UINT", "a whole number, 0 or more"},
                                                          {"N", "a whole number in its range"},
                                                          {"E", "a number"},
                                                          {"DEG", "a number"}};
    const std::size_t name = said.find("--"), equals = said.find(" = ");
    if (name == std::string::npos || equals == std::string::npos)
        return said;
    const std::string option = said.substr(name, equals - name);
    const CLI::Option* known = verb.get_option_no_throw(option);
    const auto kind = kinds.find(known && !kinds.contains(option) ? known->get_type_name() : option);
    return fmt::format("{} takes {}, not '{}'", option, kind == kinds.end() ? "a value of another type" : kind->second,
                       said.substr(equals + 3));
}

/// Rephrases a message of CLI11 such as "--frames: Value 0 not in range 1 to 100000", and of our own validators, such
/// as "--voxel: takes ...".
std::string explain_value(const std::string& option, const std::string& said) {
    constexpr std::string_view begin = ": Value ", between = " not in range ", to = " to ";
    const std::string rest = said.substr(option.size());
    const std::size_t least = rest.rfind(between), most = rest.rfind(to);
    if (!rest.starts_with(begin) || least == std::string::npos || most < least + between.size())
        return option + rest.substr(std::min<std::size_t>(1, rest.size()));
    return fmt::format("{} takes a number from {:g} to {:g}, not {}", option,
                       std::atof(rest.c_str() + least + between.size()), std::atof(rest.c_str() + most + to.size()),
                       rest.substr(begin.size(), least - begin.size()));
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

}

std::string explain(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words) {
    const std::vector<CLI::App*> parsed = program.get_subcommands();
    if (parsed.empty())
        return explain_verb(program, words) + "; see alcove --help";
    const CLI::App& verb = *parsed.front();
    if (words.front() == "help")
        return fmt::format("there is no verb 'help': use alcove {} --help", verb.get_name());
    const std::string help = fmt::format("see alcove {} --help", verb.get_name());

    const std::vector<std::string> extra = program.remaining(true);
    const auto unknown = std::find_if(extra.begin(), extra.end(), is_option);
    if (unknown != extra.end()) {
        const std::string name = unknown->substr(0, unknown->find('='));
        if (verb.get_option_no_throw(name) != nullptr)
            return fmt::format("{0} goes after the verb: alcove {1} ... {0}; {2}", name, verb.get_name(), help);
        return fmt::format("{} has no option {}{}; {}", verb.get_name(), name, guess(name, options_of(verb)), help);
    }
    const std::string said = error.what();
    const std::string option = said.substr(0, said.find(':'));
    if (error.get_name() == "ValidationError")
        return fmt::format("{}; {}", explain_value(option, said), help);
    if (error.get_name() == "ConversionError")
        return fmt::format("{}; {}", explain_conversion(verb, said), help);
    if (error.get_name() == "ArgumentMismatch")
        return fmt::format("{} {}; {}", option, said.ends_with("missing") ? "needs a value" : "is given more than once",
                           help);
    if (error.get_name() == "ExcludesError")
        return fmt::format("{} cannot be combined; {}", replaced(said, " excludes ", " and "), help);
    if (error.get_name() == "RequiresError")
        return fmt::format("{}; {}", replaced(said, " requires ", " needs "), help);
    if (error.get_name() == "RequiredError" && !extra.empty())
        return fmt::format("{} (did you mean -o {}?); {}", said, extra.front(), help);
    if (!extra.empty())
        return fmt::format("unexpected argument '{}'; {}", extra.front(), help);
    return fmt::format("{}; {}", said, help);
}

}
