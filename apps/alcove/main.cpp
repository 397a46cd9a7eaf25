#include "bake_batch.h"
#include "command_line.h"
#include "ending.h"
#include "options.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>

namespace {

enum ExitCode { done = 0, failure = 1, usage = 2, bad_input = 3 };

/// Prints a message in one line, even if it contains line breaks. \return the code
int complain(ExitCode code, const std::string& message) {
    alcove::cli::begin_to_end();
    std::fputs(fmt::format("alcove: {}\n", alcove::in_one_line(message)).c_str(), stderr);
    return code;
}

}

int main(int argc, char** argv) {
    alcove::keep_freed_memory();
    alcove::cli::end_cleanly();
    CLI::App program{"Ambient occlusion on sparse signed-distance grids: any mesh in, an AO-coloured mesh out."};
    program.set_version_flag("--version", alcove::cli::version_text());
    program.require_subcommand(1);
    program.footer("Start with: alcove bake model.ply -o model_ao.ply");
    program.get_formatter()->column_width(36);
    try {
        alcove::cli::add_bake(program);
        alcove::cli::add_render(program);
        alcove::cli::add_voxelize(program);
        alcove::cli::add_measure(program);
        alcove::cli::add_info(program);
        alcove::cli::add_methods(program);
        program.parse(argc, argv);
        if (std::fflush(stdout) != 0)
            return complain(failure, "stdout: cannot be written; is the disk full?");
        alcove::cli::begin_to_end();
        return done;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
            return program.exit(error);
        return complain(usage, alcove::cli::explain(program, error, {argv + 1, argv + argc}));
    } catch (const alcove::cli::BatchError& error) {
        return complain(error.bad_input ? bad_input : failure, error.what());
    } catch (const alcove::cli::UsageError& error) {
        return complain(usage, error.what());
    } catch (const alcove::InputError& error) {
        return complain(bad_input, error.what());
    } catch (const alcove::LimitError& error) {
        return complain(bad_input, error.what());
    } catch (const std::bad_alloc&) {
        return complain(failure, alcove::cli::out_of_memory);
    } catch (const std::exception& error) {
        return complain(failure, error.what());
    }
}
