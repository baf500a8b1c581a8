// Command lines for elsewhere, and processes that are looked at and never waited for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/launch/child_command.h"
#include "coordinator/launch/host_launcher.h"
#include "coordinator/launch/slurm_launcher.h"

namespace fatmc {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr milliseconds kLong{60'000};

TEST(CommandLine, QuotesWhatAShellWouldRead) {
  EXPECT_EQ(shell_word("/opt/fatmc-worker"), "/opt/fatmc-worker");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(run_command({"sh", "-c", "printf %s " + shell_word("a'b \"c\" $d\n;")}, "", kLong).output,
            "a'b \"c\" $d\n;");
  EXPECT_EQ(command_line({"w", "tcp://h:1", "my keys", 4, std::chrono::seconds(9)}),
            "w --connect tcp://h:1 --keys 'my keys' --jobs 4 --leave-after 9");
}

TEST(LaunchLine, PutsTheCommandThroughTwoShellsUnharmed) {
  const auto line = fill_line("sh -c {command} # {host}", "node", "printf %s " + shell_word("a 'b' $c"));
  ASSERT_TRUE(line);
  EXPECT_EQ(run_command({"sh", "-c", *line}, "", kLong).output, "a 'b' $c");
  EXPECT_FALSE(fill_line("ssh {host}", "node", "c"));
}

TEST(Hosts, ComeWithTheirJobs) {
  EXPECT_THAT(*parse_hosts("node1,ada@node2:4"), ElementsAre(Host{"node1", 1}, Host{"ada@node2", 4}));
  for (const char* wrong : {"", "a,,b", "a:", "a:0", "a:4x", ":4", "-oProxyCommand=x"})
    EXPECT_FALSE(parse_hosts(wrong)) << wrong;
}

TEST(Command, GivesCodeOutputAndTheFirstLineOfErrors) {
  const CommandResult result =
      run_command({"sh", "-c", "cat; echo one >&2; echo two >&2; exit 3"}, "in", kLong);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.output, "in");
  EXPECT_EQ(result.errors, "one");
}

TEST(Command, ThatDoesNotExistIsAResultToo) {
  const CommandResult result = run_command({"/no/such/program"}, "", kLong);
  EXPECT_EQ(result.exit_code, 127);
  EXPECT_THAT(result.errors, HasSubstr("/no/such/program"));
}

TEST(Command, IsKilledAtItsDeadlineWithAllThatItStarted) {
  ChildCommand command;
  const auto now = ChildCommand::Time::clock::now();
  command.start({"sh", "-c", "sleep 1000 & wait"}, "", now + kLong);
  EXPECT_FALSE(command.take(now));
  const auto result = command.take(now + kLong);  // the clock of the test, not of the wall
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->ok());
  EXPECT_THAT(result->errors, HasSubstr("no answer in time"));
}

TEST(Pilot, IsNamedByCampaignAndEndpoint) {
  EXPECT_EQ(pilot_name("c", "tcp://h:1"), pilot_name("c", "tcp://h:1"));
  EXPECT_NE(pilot_name("c", "tcp://h:1"), pilot_name("c", "tcp://h:2"));
  EXPECT_NE(pilot_name("c", "tcp://h:1"), pilot_name("d", "tcp://h:1"));
  EXPECT_THAT(pilot_script({"w", "tcp://h:1", "", 2, std::chrono::seconds(9)}),
              HasSubstr("exec w --connect tcp://h:1 --jobs 2 --leave-after 9\n"));
}

// Ends whatever comes: the first line of its errors is what the user reads.
TEST(HostLauncher, GivesAHostUpWhoseWorkersEndInVain) {
  HostOptions options;
  options.worker.program = "w";
  options.hosts = {{"here", 1}};
  options.line = "echo cannot {host} >&2; exit 255 # {command}";
  options.pause = milliseconds(0);
  options.ends_in_vain = 3;
  HostLauncher launcher(options);
  for (auto time = Launcher::Time{}; launcher.failure().empty(); time += milliseconds(1))
    launcher.tick({5, 0, 0}, time);
  EXPECT_THAT(launcher.failure(), HasSubstr("the last was here (exit code 255: cannot here)"));
}

TEST(HostLauncher, GivesAHostUpAtOnceWhoseWorkerIsUsedWrongly) {
  HostOptions options;
  options.worker.program = "w";
  options.hosts = {{"here", 1}};
  options.line = "echo no keys at {host} >&2; exit 2 # {command}";
  HostLauncher launcher(options);
  while (launcher.failure().empty()) launcher.tick({5, 0, 0}, Launcher::Time{});
  EXPECT_THAT(launcher.failure(), HasSubstr("no keys at here"));
}

}  // namespace
}  // namespace fatmc
