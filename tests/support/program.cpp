#include "tests/support/program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace scree::test {
namespace {

std::string textOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(file)), {});
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const std::function<void()>& prepare)
{
    outPath_ = (std::filesystem::temp_directory_path() / "scree_out_XXXXXX").string();
    errPath_ = (std::filesystem::temp_directory_path() / "scree_err_XXXXXX").string();
    const int out = ::mkstemp(outPath_.data()), err = ::mkstemp(errPath_.data());
    std::vector<char*> words = {const_cast<char*>(SCREE_PROGRAM)};
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
        ::dup2(out, STDOUT_FILENO);
        ::dup2(err, STDERR_FILENO);
        if (prepare) prepare();
        ::execv(words[0], words.data());
        ::_exit(127);
    }
    ::close(out);
    ::close(err);
}

void Program::signal(int number) const
{
    ::kill(child_, number);
}

Outcome Program::wait()
{
    int status = 0;
    ::waitpid(child_, &status, 0);
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    outcome.out = textOf(outPath_);
    outcome.err = textOf(errPath_);
    ::unlink(outPath_.c_str());
    ::unlink(errPath_.c_str());
    return outcome;
}

Outcome runScree(const std::vector<std::string>& arguments)
{
    return Program(arguments).wait();
}

}  // namespace scree::test
