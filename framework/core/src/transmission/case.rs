//! Common settings of a series of points: gear state, ports with given speed, ports with given torque.

use std::sync::{Mutex, PoisonError};

use super::Transmission;
use super::states::{GearState, all_ports, explain, in_state, path_of_state, prescribed};
use super::statics::LoadFactors;
use crate::codes;
use crate::document::{Diagnostic, classify};
use crate::flow::{Flow, FlowFault, LoadedDrag, Reading};
use crate::kinematics::Motion;

/// A gear state with prescribed ports, factored once.
#[derive(Debug, Clone)]
pub struct Case {
    pub(crate) state: usize,
    pub(crate) motion: Motion,
    pub(crate) flow: Flow,
    /// Ports with a given speed, in the order of a point's speeds.
    pub speed_ports: Vec<usize>,
    /// Ports with a given torque, in the order of a point's torques.
    pub torque_ports: Vec<usize>,
    /// Number of speeds added by rules.
    pub(crate) ruled_speeds: usize,
}

/// The cases of some gear states that were prepared so far, shared by transmissions whose gear states are the same.
#[derive(Debug, Default)]
pub(crate) struct Cases(Mutex<Vec<(Asked, Case)>>);

/// Maximum number of cases that are kept: gear states times the ports that a study uses.
const MOST_KEPT: usize = 64;

/// What determines a case: gear state, ports with given speed, ports with given torque, drags that depend on torques.
#[derive(Debug, PartialEq)]
struct Asked {
    state: usize,
    speed_ports: Vec<usize>,
    torque_ports: Vec<usize>,
    drags: Vec<LoadedDrag>,
}

impl Cases {
    fn get(&self, asked: &Asked) -> Option<Case> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter()
            .find(|(known, _)| known == asked)
            .map(|(_, case)| case.clone())
    }

    fn keep(&self, asked: Asked, case: &Case) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() < MOST_KEPT {
            kept.push((asked, case.clone()));
        }
    }
}

impl Transmission {
    /// Prepares a gear state for points that give speeds and torques at the named ports.
    ///
    /// Empty `speeds` means the default of the state: as many ports as it has degrees of freedom, `input` first. The number of
    /// torques must equal the number of ports minus the degrees of freedom; only the caller drops surplus ones from the end of an
    /// automatic choice.
    ///
    /// # Errors
    /// If ports are unknown, depend on each other, or are too many or too few.
    pub fn case(&self, gear: &str, speeds: &[&str], torques: &[&str]) -> Result<Case, Vec<Diagnostic>> {
        let index = self.state(gear).map_err(|e| vec![e])?;
        let state = &self.states[index];
        let path = path_of_state(gear);
        let mut found = Vec::new();
        let mut numbers = |names: &[&str]| -> Vec<usize> {
            names
                .iter()
                .filter_map(|name| match self.port(name) {
                    Ok(port) => Some(port),
                    Err(error) => {
                        found.push(error);
                        None
                    }
                })
                .collect()
        };
        let speed_ports = if speeds.is_empty() {
            state.speed_ports.clone()
        } else {
            numbers(speeds)
        };
        let torque_ports = numbers(torques);
        self.check_given(state, &speed_ports, &torque_ports, &path, &mut found);
        if !found.is_empty() {
            classify(&mut found, codes::GIVEN);
            return Err(found);
        }
        let asked = Asked {
            state: index,
            speed_ports: speed_ports.clone(),
            torque_ports: torque_ports.clone(),
            drags: self.loaded_drags(index),
        };
        if let Some(case) = self.cases.get(&asked) {
            return Ok(case);
        }
        let (motion, equal) = self.motion(state, &speed_ports, &path)?;
        let mut given: Vec<usize> = torque_ports.iter().map(|p| self.ports[*p].member).collect();
        given.extend(equal.iter().copied());
        let mut unknown: Vec<usize> = self
            .ports
            .iter()
            .map(|p| p.member)
            .filter(|m| !given.contains(m))
            .collect();
        unknown.extend(state.standing.iter().copied());
        let flow = Flow::new(
            &state.train,
            state.meshes.clone(),
            // A torque split is used if its meshes close a loop; in other states each carries its torque alone.
            state
                .shares
                .iter()
                .filter(|s| {
                    motion
                        .loops
                        .iter()
                        .any(|rows| rows.contains(&s.a.0) && rows.contains(&s.b.0))
                })
                .copied()
                .collect(),
            &motion.loops,
            (unknown, given),
            asked.drags.clone(),
        )
        .map_err(|fault| vec![self.flow_fault(&fault, state, equal.len(), &path).code(codes::GIVEN)])?;
        let case = Case {
            state: index,
            motion,
            flow,
            ruled_speeds: state.standing.len() + equal.len(),
            speed_ports,
            torque_ports,
        };
        self.cases.keep(asked, &case);
        Ok(case)
    }

    /// The components whose loss depends on torques in a gear state, and on which.
    fn loaded_drags(&self, state: usize) -> Vec<LoadedDrag> {
        let loaded = self.components.iter().enumerate();
        let loaded = loaded.filter(|(_, component)| component.loaded && !component.off);
        let drags = loaded.map(|(i, component)| {
            let port = |port: usize| Reading::Port(self.ports[port].member);
            let mut reads = Vec::new();
            let group = component.group(&self.loads);
            if let Some(group) = group.map(|group| &self.loads.groups()[group]) {
                reads.extend(group.meshes.iter().map(|mesh| Reading::Row(*mesh)));
                for support in &group.supports {
                    let imported = self.imported.as_ref();
                    reads.extend(imported.and_then(|loads| loads.reads(state, *support)).map(port));
                    let factors = self.load_factors.get(*support);
                    reads.extend(factors.into_iter().flat_map(LoadFactors::reads).map(port));
                }
            }
            LoadedDrag {
                component: i,
                between: component.between.map(|member| member.map(usize::from)),
                reads,
                group,
            }
        });
        drags.collect()
    }

    /// Checks that each speed and torque is given once, and no speed at a port that stands.
    fn check_given(
        &self,
        state: &GearState,
        speed_ports: &[usize],
        torque_ports: &[usize],
        path: &str,
        found: &mut Vec<Diagnostic>,
    ) {
        for (ports, what) in [(speed_ports, "speed"), (torque_ports, "torque")] {
            for (i, port) in ports.iter().enumerate() {
                if ports[..i].contains(port) {
                    let name = &self.ports[*port].name;
                    found.push(
                        Diagnostic::error(path, format!("the {what} at `{name}` is stated twice"))
                            .help("state it once"),
                    );
                }
            }
        }
        for port in speed_ports {
            let port = &self.ports[*port];
            if state.standing.contains(&port.member) {
                found.push(
                    Diagnostic::error(path, format!("`{}` is stationary in `{}`", port.name, state.name))
                        .help("state no speed there, or remove it from `standstill`"),
                );
            }
        }
    }

    /// The motion with prescribed speeds, and the rules of equal speed that it keeps: a point that prescribes both sides of a
    /// differential drops them.
    fn motion(
        &self,
        state: &GearState,
        speed_ports: &[usize],
        path: &str,
    ) -> Result<(Motion, Vec<usize>), Vec<Diagnostic>> {
        let columns = all_ports(state, &self.ports);
        let fixed = prescribed(state, &self.ports, speed_ports);
        let faults = match Motion::new(&state.train, &columns, &fixed) {
            Ok(motion) => return Ok((motion, state.equal.clone())),
            Err(faults) => faults,
        };
        let unruled = |columns: &[usize]| -> Vec<usize> {
            let columns = columns.iter().copied();
            columns.filter(|c| !state.equal.contains(c)).collect()
        };
        match Motion::new(&state.train, &unruled(&columns), &unruled(&fixed)) {
            Ok(motion) if !state.equal.is_empty() => Ok((motion, Vec::new())),
            _ => Err(faults
                .iter()
                .map(|f| explain(f, state, &self.members, &self.ports, path))
                .collect()),
        }
    }

    /// Speeds of all members for the speeds at the case's speed ports. \[rad/s\]
    pub fn speeds(&self, case: &Case, given: &[f64]) -> Vec<f64> {
        let mut prescribed = given.to_vec();
        prescribed.resize(case.speed_ports.len() + case.ruled_speeds, 0.0);
        let mut speeds = vec![0.0; case.flow.columns()];
        case.motion.speeds(&prescribed, &mut speeds);
        speeds
    }

    /// Checks that one given speed and at most one given torque determine a gear state, as in every point of a study.
    ///
    /// # Errors
    /// The required numbers, with a fix.
    pub fn takes_one(&self, state: usize) -> Result<(), Diagnostic> {
        let (torques, described) = (self.torques_needed(state), &self.states[state]);
        if described.freedom <= 1 && torques <= 1 {
            return Ok(());
        }
        let reference = self.reference_port();
        let others = self.ports.iter().enumerate().filter(|(i, _)| *i != reference);
        let others: Vec<&str> = others.map(|(_, port)| port.name.as_str()).collect();
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let error = Diagnostic::error(
            path_of_state(&described.name),
            format!(
                "`{}` requires {} given speed{} and {torques} given torque{}, but an analysis states one of each",
                described.name,
                described.freedom,
                plural(described.freedom),
                plural(torques)
            ),
        );
        let error = error.code(codes::GIVEN);
        let free: Vec<&str> = described
            .speed_ports
            .iter()
            .map(|port| self.ports[*port].name.as_str())
            .collect();
        let has_two = self.machines().len() > 1;
        Err(if has_two && torques > 1 {
            error.help(
                "`solve` takes all of them; an analysis does not, since nothing states how the machines share the torque: use a gear in which a \
                 planetary set divides it",
            )
        } else if let ([.., to, port], true) = (&free[..], has_two) {
            error.help(format!(
                "keep a ratio of two speeds: `gear_states: {{ {}: {{ engaged: [{}], speed_ratio: {{ port: {port}, to: {to}, ratio: 1 }} }} }}`; \
                 `solve` takes any speeds",
                described.name,
                described.engaged.join(", ")
            ))
        } else if others.len() > 1 {
            error
                .note(format!("ports: {}, {}", self.ports[reference].name, others.join(", ")))
                .help(format!(
                    "write `conditions: {{ wheels: [{}] }}` in the study if these have equal speed, or remove ports without power from `ports`",
                    others.join(", ")
                ))
        } else {
            error.help("use a gear state that connects the ports; `spin_loss` includes all states without load")
        })
    }

    /// Number of torques that a point of a gear state must state.
    pub fn torques_needed(&self, state: usize) -> usize {
        let state = &self.states[state];
        self.ports.len().saturating_sub(state.freedom + state.equal.len())
    }

    fn flow_fault(&self, fault: &FlowFault, state: &GearState, ruled: usize, path: &str) -> Diagnostic {
        let names: Vec<&str> = self.ports.iter().map(|p| p.name.as_str()).collect();
        match fault {
            FlowFault::Count { needed, given } => {
                let (needed, given) = (needed.saturating_sub(ruled), given.saturating_sub(ruled));
                let help = if needed == 0 {
                    format!("state no torque in `{}`: the drags determine all of them", state.name)
                } else {
                    format!("state {needed} of the torques at {}", names.join(", "))
                };
                Diagnostic::error(
                    path,
                    format!("`{}` requires {needed} given torques, not {given}", state.name),
                )
                .help(help)
            }
            FlowFault::Redundant { loops } => {
                let rows: Vec<String> = loops
                    .iter()
                    .map(|rows| {
                        rows.iter()
                            .filter_map(|r| match state.rows.get(*r) {
                                Some(super::states::RowName::Path(path)) => Some(path.as_str()),
                                _ => None,
                            })
                            .collect::<Vec<_>>()
                            .join(", ")
                    })
                    .collect();
                Diagnostic::error(
                    "torque_shares",
                    format!(
                        "parallel paths split the torque{}, but the split is not stated",
                        in_state(&state.name)
                    ),
                )
                .note(format!("the loop: {}", rows.join("; ")))
                .help("add `torque_shares: [{ member: ..., meshes: [..., ...], parts: [0.5, 0.5] }]`")
                .code(codes::POWER_FLOW)
            }
            FlowFault::Singular => Diagnostic::error(
                path,
                format!("the given torques depend on each other{}", in_state(&state.name)),
            )
            .help("state a torque at another port, or correct the torque shares")
            .code(codes::POWER_FLOW),
        }
    }
}
