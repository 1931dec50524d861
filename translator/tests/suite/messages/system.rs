//! Agents that talk with each other over a network that loses, delays and reorders what they say.

use translator::interpreter::Interpreter;
use translator::syntax::ast::Performative;

use super::talker::{Choices, Command, Talker};
use super::traces::Trace;

/// Steps of each agent.
pub(super) const STEPS: usize = 200;
/// A message is received before at most so many others that were sent to the same agent earlier.
const REORDERED: usize = 4;

/// An agent of a system.
pub(super) struct Member {
    /// Which of the system's texts it has; none if it says anything at any time.
    pub(super) kind: Option<usize>,
    /// What happened to it.
    pub(super) commands: Vec<Command>,
    /// What it did.
    pub(super) trace: Trace,
    steps: usize,
}

/// What became of what agents sent to each other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Network {
    pub(super) received: u64,
    pub(super) lost: u64,
    /// Received behind a later one.
    pub(super) reordered: u64,
}

/// Runs a system of agents of these kinds. Each peer is one of them, or hostile.
pub(super) fn run(
    talker: &Talker,
    kinds: &[Interpreter],
    choices: &mut Choices<'_>,
) -> (Vec<Member>, Network) {
    let mut agents: Vec<Interpreter> = Vec::new();
    let mut members = Vec::new();
    for me in 0..talker.peers {
        let kind = choices.pick(kinds.len());
        // One at least is an agent.
        let is_hostile = me > 0 && choices.chance(25);
        agents.push(kinds[kind].clone());
        let kind = (!is_hostile).then_some(kind);
        let mut member = Member { kind, commands: Vec::new(), trace: Trace::default(), steps: 0 };
        member.executes(&mut agents[me], Command::Init(me));
        // In the C, agents follow each other.
        member.executes(&mut agents[me], Command::Time(0));
        members.push(member);
    }
    let loss = choices.of(&[0, 10, 30, 60]);
    let mut network = Network::default();
    // Messages under way, in the order in which they were sent, and who receives them.
    let mut under_way: Vec<(usize, Command)> = Vec::new();
    loop {
        let going = (0..members.len()).filter(|me| members[*me].steps < STEPS);
        let going: Vec<usize> = going.collect();
        if going.is_empty() {
            return (members, network);
        }
        let me = choices.of(&going);
        if members[me].kind.is_none() {
            members[me].steps += 1;
            let to = choices.pick(talker.peers);
            under_way.push((to, talker.said(me, choices)));
            continue;
        }
        let mail = under_way.iter().enumerate().filter(|(_, (to, _))| *to == me);
        let mail: Vec<usize> = mail.map(|(index, _)| index).take(REORDERED).collect();
        let command = match choices.pick(16) {
            7..14 if !mail.is_empty() => {
                let message = choices.of(&mail);
                let (_, command) = under_way.remove(message);
                if choices.chance(loss) {
                    network.lost += 1;
                    continue;
                }
                network.received += 1;
                network.reordered += u64::from(message != mail[0]);
                command
            }
            14 | 15 => talker.surroundings(choices),
            _ => Command::Step,
        };
        members[me].executes(&mut agents[me], command);
        for (action, arguments) in std::mem::take(&mut members[me].trace.sent) {
            let (to, message) = message(talker, me, &action, &arguments);
            if to < members.len() {
                under_way.push((to, message));
            }
        }
    }
}

impl Member {
    fn executes(&mut self, agent: &mut Interpreter, command: Command) {
        self.steps += usize::from(matches!(command, Command::Step));
        self.trace.executes(agent, &command);
        self.commands.push(command);
    }
}

/// Who receives what an action sends, and what.
fn message(talker: &Talker, from: usize, action: &str, arguments: &[i64]) -> (usize, Command) {
    let performatives =
        [Performative::Tell, Performative::Untell, Performative::Achieve, Performative::Unachieve];
    let sent = performatives.iter().find_map(|performative| {
        let about = action.strip_prefix(&format!("send_{}_", performative.name()))?;
        Some((*performative, talker.predicates.iter().find(|message| message.name == about)?.name))
    });
    let (performative, name) = sent.unwrap_or_else(|| panic!("{action} sends nothing"));
    let (to, arguments) = arguments.split_first().unwrap();
    let to = usize::try_from(*to).unwrap();
    (to, Command::Receive(from, performative, name, arguments.to_vec()))
}
