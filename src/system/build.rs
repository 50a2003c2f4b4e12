//! Scene to plant: names to indices, specs to elements.

use crate::hydraulics::Chain;
use crate::mechanism::{Coordinate, CoordinateKind, Mechanism, Route};
use crate::muscle::{Coil, Friction, Stop, Wall, WallCondition, WallGeometry};
use crate::recording::parse_column;
use crate::scene::{CableSpec, MuscleSpec, MusclesSpec, Scene, TubeSpec, WallSpec};

use super::SystemError;
use super::coordinates::{CoordinateStop, Coordinates};
use super::elastic::Elastic;
use super::extras::{MechanismExtras, MuscleExtras};
use super::install::{Site, install, install_laws, settle_memory};
use super::laws::Wrong;
use super::plant::{CablePlant, Drive, InputSpan, MusclePlant, Plant};
use super::state::PlantState;

/// A plant with its starting state, and how its parts hang on the mechanism.
#[derive(Clone)]
pub(super) struct Built {
    pub plant: Plant<f64>,
    pub state: PlantState<f64>,
    /// Route of each cable, and the path length at which its stretch is that of the start.
    pub routes: Vec<Route>,
    pub path_0_m: Vec<f64>,
    /// Of each cable: minus the part of its stretch that the muscle's end has at the start, m.
    pub start_offset_m: Vec<f64>,
    /// Of each muscle of the scene: its index among the plant's muscles (`None` for a displacement model).
    pub muscle_index: Vec<Option<usize>>,
    /// Of each muscle pulling a cable: the coordinate of its free end.
    pub end_coordinate: Vec<Option<usize>>,
    /// Displacement models: muscle of the scene, cable it moves, index of its pseudo-input.
    pub displacements: Vec<Displacement>,
}

/// A muscle that follows its plunger by a displacement-form hysteresis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displacement {
    pub muscle: usize,
    pub plunger: usize,
    /// Index of the pseudo-input that carries its elongation, m.
    pub input: usize,
}

struct Builder<'a> {
    scene: &'a Scene,
    mechanism: Option<&'a Mechanism>,
    /// Number of coordinates: the mechanism's, then one per muscle end.
    dim: usize,
    joints: usize,
}

/// Builds the plant of a scene around its mechanism.
pub(super) fn build(scene: &Scene, mechanism: Option<&Mechanism>) -> Result<Built, SystemError> {
    super::joint_kinds::check(scene, mechanism)?;
    let joints = mechanism.map_or(0, |m| m.coordinates().len());
    let displaced = scene.file.muscles.as_ref().is_some_and(|m| m.displacement.is_some());
    let ends = if displaced { 0 } else { scene.file.muscle.iter().filter(|m| m.cable.is_some()).count() };
    Builder { scene, mechanism, dim: joints + ends, joints }.build(displaced)
}

impl Builder<'_> {
    fn build(&self, displaced: bool) -> Result<Built, SystemError> {
        let (cables, routes) = self.cables()?;
        let mut built = Built {
            plant: Plant {
                coordinates: self.coordinates()?,
                muscles: Vec::new(),
                cables,
                mechanism: MechanismExtras::default(),
                laws: None,
                posed: None,
            },
            state: self.start(displaced),
            path_0_m: vec![0.0; routes.len()],
            start_offset_m: vec![0.0; routes.len()],
            routes,
            muscle_index: Vec::new(),
            end_coordinate: Vec::new(),
            displacements: Vec::new(),
        };
        let mut next_end = self.joints;
        for (index, (spec, make)) in self.scene.file.muscle.iter().zip(&self.scene.makes).enumerate() {
            if displaced {
                self.add_displacement(index, spec, &mut built)?;
            } else {
                self.add_muscle(spec, make, &mut next_end, &mut built)?;
            }
        }
        self.settle_cables(&mut built);
        self.install_effects(&mut built)?;
        Ok(built)
    }

    fn error(&self, table: String, message: String, remedy: String) -> SystemError {
        SystemError::Name { file: self.scene.path.clone(), table, message, remedy }
    }

    fn joint(&self, table: &str, name: &str) -> Result<usize, SystemError> {
        let coordinates = self.mechanism.map_or(&[][..], Mechanism::coordinates);
        coordinates.iter().position(|c| c.name == name).ok_or_else(|| {
            let known: Vec<&str> = coordinates.iter().map(|c| c.name.as_str()).collect();
            self.error(
                table.to_owned(),
                format!("joint = \"{name}\" is no free joint of the mechanism"),
                match known.is_empty() {
                    true => "unlock a joint, or remove this table: the mechanism has no free one".to_owned(),
                    false => format!("use one of: {} (locked and following joints do not count)", known.join(", ")),
                },
            )
        })
    }

    fn is_locked(&self, name: &str) -> bool {
        let joints = self.scene.file.mechanism.iter().flat_map(|m| &m.joint);
        joints.filter(|j| j.locked_m.is_some() || j.locked_rad.is_some()).any(|j| j.joints.iter().any(|n| n == name))
    }

    fn coordinates(&self) -> Result<Coordinates<f64>, SystemError> {
        let n = self.dim;
        let mut c = Coordinates {
            inertia: vec![0.0; n * n],
            damping: vec![0.0; n],
            stiffness: vec![0.0; n],
            rest: vec![0.0; n],
            force: vec![0.0; n],
            stops: Vec::new(),
            contact: None,
        };
        for (i, joint) in self.mechanism.iter().flat_map(|m| m.coordinates()).enumerate() {
            c.damping[i] = joint.damping;
            c.stiffness[i] = joint.stiffness;
            c.rest[i] = joint.rest;
            c.stops.extend(stops(i, joint));
        }
        for (i, make) in (self.joints..n).zip(self.makes_on_cables()) {
            c.inertia[i * n + i] = make.end_mass_kg;
        }
        Ok(c)
    }

    fn start(&self, displaced: bool) -> PlantState<f64> {
        let mut y = vec![0.0; self.dim];
        for (y, joint) in y.iter_mut().zip(self.mechanism.iter().flat_map(|m| m.coordinates())) {
            *y = joint.initial;
        }
        for (y, make) in y[self.joints..].iter_mut().zip(self.makes_on_cables()) {
            *y = make.pre_elongation_ratio * make.rest_length_m;
        }
        let muscles = if displaced { 0 } else { self.scene.file.muscle.len() };
        let segments = self.scene.file.hydraulics.as_ref().map_or(0, |h| h.line.segments);
        PlantState::at_rest(&y, muscles, segments)
    }

    /// What the muscles are made like whose ends are coordinates of their own, in order.
    fn makes_on_cables(&self) -> impl Iterator<Item = &MusclesSpec> {
        let muscles = self.scene.file.muscle.iter().zip(&self.scene.makes);
        muscles.filter(|(spec, _)| spec.cable.is_some()).map(|(_, make)| make)
    }

    fn cables(&self) -> Result<(Vec<CablePlant<f64>>, Vec<Route>), SystemError> {
        let mut cables = Vec::new();
        let mut routes = Vec::new();
        for spec in &self.scene.file.cable {
            let table = format!("[[cable]] \"{}\"", spec.name);
            let Some(mechanism) = self.mechanism else {
                return Err(self.error(
                    table,
                    "there is no [mechanism] to pull on".to_owned(),
                    "add [mechanism] with a URDF".to_owned(),
                ));
            };
            let route = mechanism
                .route(&spec.route)
                .map_err(|source| SystemError::Mechanism { file: self.scene.path.clone(), source })?;
            cables.push(self.cable(spec, mechanism, &route));
            routes.push(route);
        }
        Ok((cables, routes))
    }

    fn cable(&self, spec: &CableSpec, mechanism: &Mechanism, route: &Route) -> CablePlant<f64> {
        let mut jacobian = vec![0.0; self.dim];
        mechanism.path_length(route, &mut jacobian[..self.joints]);
        let drive = spec.drive.as_ref().and_then(|d| self.input(&d.input).map(|i| (i, d.lever_m)));
        CablePlant {
            stiffness_n_m: spec.stiffness_n_m,
            damping_n_s_m: spec.damping_n_s_m,
            stretch_0_m: 0.0,
            jacobian,
            drive,
            friction: None,
            lean: None,
        }
    }

    fn input(&self, channel: &str) -> Option<usize> {
        self.scene.file.input.iter().position(|i| i.channel == channel)
    }

    /// Index of a muscle's input; the scene has been checked to have it.
    fn muscle_input(&self, spec: &MuscleSpec) -> Result<usize, SystemError> {
        self.input(&spec.input).ok_or_else(|| {
            self.error(
                format!("[[muscle]] \"{}\"", spec.name),
                format!("input = \"{}\" is not an input", spec.input),
                "add the [[input]]".to_owned(),
            )
        })
    }

    fn elastic(&self, make: &MusclesSpec) -> Result<Elastic<f64>, SystemError> {
        if let Some(tube) = &make.tube {
            return tube_elastic(tube, make.rest_length_m)
                .map_err(|source| SystemError::Muscle { file: self.scene.path.clone(), source });
        }
        let (k, b) = make.linear.map_or((0.0, 0.0), |l| (l.stiffness_n_m, l.pressure_gain_m2));
        Ok(Elastic::Linear { stiffness_n_m: k, pressure_gain_m2: b })
    }

    fn add_muscle(
        &self,
        spec: &MuscleSpec,
        make: &MusclesSpec,
        next_end: &mut usize,
        built: &mut Built,
    ) -> Result<(), SystemError> {
        let elastic = self.elastic(make)?;
        let pre = make.pre_elongation_ratio * make.rest_length_m;
        let table = format!("[[muscle]] \"{}\"", spec.name);
        let mut jacobian = vec![0.0; self.dim];
        let mut elongation_0 = 0.0;
        let mut end = None;
        if let Some(joint) = &spec.joint {
            if self.is_locked(joint) {
                elongation_0 = pre;
            } else {
                let i = self.joint(&table, joint)?;
                jacobian[i] = 1.0;
                elongation_0 = pre - built.state.y()[i];
            }
        } else {
            jacobian[*next_end] = 1.0;
            let cable = self.scene.file.cable.iter().position(|c| Some(&c.name) == spec.cable.as_ref());
            if let Some(cable) = cable {
                // The cable's near end moves with the muscle's: elongating slackens it.
                built.plant.cables[cable].jacobian[*next_end] = -1.0;
            }
            end = Some(*next_end);
            *next_end += 1;
        }
        let pressure = elastic.holding_pressure_pa(pre, make.initial_load_n);
        let drive = self.drive(spec)?;
        let friction = make.friction.map(|f| Friction {
            m0_n: f.m0_n,
            m1_n_pa: f.m1_n_pa,
            presliding_length_m: f.presliding_length_m,
            a: f.a,
            nu: f.nu,
            n: f.n,
            rho: f.rho,
        });
        let stop = make.tube.as_ref().and_then(|t| t.closed_stop);
        built.muscle_index.push(Some(built.plant.muscles.len()));
        built.end_coordinate.push(end);
        if let Drive::Hydraulic { .. } = drive {
            built.state.pressures_mut(built.plant.muscles.len()).fill(pressure);
        }
        built.plant.muscles.push(MusclePlant {
            drive,
            elastic,
            friction,
            damping_n_s_m: make.damping_n_s_m,
            stop: stop.map(|s| Stop { stiffness_n_m: s.stiffness_n_m, damping_n_s_m: s.damping_n_s_m }),
            jacobian,
            elongation_0_m: elongation_0,
            extras: MuscleExtras::default(),
            slow_at: 0,
        });
        Ok(())
    }

    fn drive(&self, spec: &MuscleSpec) -> Result<Drive<f64>, SystemError> {
        let input = self.muscle_input(spec)?;
        let by_pressure = parse_column(&spec.input)?.unit.si_suffix == "pa";
        match &self.scene.file.hydraulics {
            Some(h) if !by_pressure => {
                let chain = Chain::new(&h.line, &h.fluid, h.upstream_compliance_m3_pa, h.downstream_compliance_m3_pa);
                Ok(Drive::Hydraulic { chain, syringe_area_m2: h.syringe.area_m2(), plunger: input })
            }
            _ => Ok(Drive::Pressure { pressure: input }),
        }
    }

    fn add_displacement(&self, muscle: usize, spec: &MuscleSpec, built: &mut Built) -> Result<(), SystemError> {
        let plunger = self.muscle_input(spec)?;
        let input = self.scene.file.input.len() + built.displacements.len();
        if let Some(cable) = self.scene.file.cable.iter().position(|c| Some(&c.name) == spec.cable.as_ref()) {
            built.plant.cables[cable].drive = Some((input, -1.0));
        }
        built.displacements.push(Displacement { muscle, plunger, input });
        built.muscle_index.push(None);
        built.end_coordinate.push(None);
        Ok(())
    }

    /// Where the mechanism's effects act; every coordinate of a full scene is one hinge.
    fn site(&self, plant: &Plant<f64>) -> Site {
        let wraps = self.scene.file.cable.iter().map(|c| c.sheath_angle_rad).collect();
        let coordinates = self.mechanism.map_or(&[][..], Mechanism::coordinates);
        let names = coordinates.iter().map(|c| vec![c.name.clone()]).collect();
        Site::of(plant, (names, slides(coordinates)), vec![1; self.dim], wraps)
    }

    fn install_effects(&self, built: &mut Built) -> Result<(), SystemError> {
        let site = self.site(&built.plant);
        let settled: Vec<f64> = built.plant.cables.iter().map(|c| c.stretch_0_m).collect();
        for (i, table) in self.scene.file.effect.iter().enumerate() {
            let effect = table
                .effect()
                .map_err(|e| self.error(format!("[[effect]] {} \"{}\"", i + 1, table.name), e.message, e.remedy))?;
            install(&mut built.plant, &site, &effect);
        }
        // Cables on via points take their rest anew at every engine step: slack must come along.
        for ((offset, cable), before) in built.start_offset_m.iter_mut().zip(&built.plant.cables).zip(settled) {
            *offset += cable.stretch_0_m - before;
        }
        install_laws(&mut built.plant, &site, &self.scene.laws).map_err(|wrong| wrong_law(self.scene, wrong))?;
        settle_memory(&mut built.plant, &mut built.state);
        Ok(())
    }

    /// Sets every cable's rest so that it starts with its pretension.
    fn settle_cables(&self, built: &mut Built) {
        // Displacements of plungers and drives count from the start state of the scene.
        let inputs = vec![InputSpan::default(); self.scene.file.input.len() + built.displacements.len()];
        for i in 0..built.plant.cables.len() {
            built.plant.cables[i].stretch_0_m = 0.0;
            let (stretch, _, _) = built.plant.cable(i, &built.state, &inputs, 0.0);
            let spec = &self.scene.file.cable[i];
            built.plant.cables[i].stretch_0_m = spec.pretension_n / spec.stiffness_n_m - stretch;
            let ends = self.joints..self.dim;
            built.start_offset_m[i] =
                -ends.map(|j| built.plant.cables[i].jacobian[j] * built.state.y()[j]).sum::<f64>();
            if let Some(mechanism) = self.mechanism {
                built.path_0_m[i] = mechanism.path_length(&built.routes[i], &mut vec![0.0; self.joints]);
            }
        }
    }
}

/// Whether each coordinate slides.
pub(super) fn slides(coordinates: &[Coordinate]) -> Vec<bool> {
    coordinates.iter().map(|c| c.kind == CoordinateKind::Length).collect()
}

/// A law that the rig cannot have.
pub(super) fn wrong_law(scene: &Scene, (name, (message, remedy)): (String, Wrong)) -> SystemError {
    SystemError::Name { file: scene.path.clone(), table: format!("[[law]] \"{name}\""), message, remedy }
}

fn stops(coordinate: usize, joint: &Coordinate) -> impl Iterator<Item = CoordinateStop> {
    let stop = move |side: f64, s: &crate::mechanism::Stop| CoordinateStop {
        coordinate,
        position: s.position,
        side,
        stiffness: s.stiffness,
        damping: s.damping,
    };
    let lower = joint.lower_stop.as_ref().map(|s| stop(1.0, s));
    let upper = joint.upper_stop.as_ref().map(|s| stop(-1.0, s));
    lower.into_iter().chain(upper)
}

fn tube_elastic(tube: &TubeSpec, rest_length_m: f64) -> Result<Elastic<f64>, crate::muscle::MuscleError> {
    let geometry = WallGeometry {
        inner_radius_m: tube.inner_diameter_m / 2.0,
        outer_radius_m: tube.outer_diameter_m / 2.0,
        rest_length_m,
    };
    Ok(Elastic::Tube {
        wall: Wall::new(geometry, tube.material)?,
        condition: match tube.wall {
            WallSpec::Held => WallCondition::Held,
            WallSpec::Unilateral => WallCondition::Unilateral,
        },
        coil: Coil { stiffness_n_m: tube.coil.stiffness_n_m, preload_n: tube.coil.preload_n },
        area_growth_1_m: tube.area_growth_1_m,
    })
}
