//! Laws that nobody chose, in the concealing plant and as text in a scene: two programs that share no equation agree.

use smam::conceal::{
    Calibration, ChannelNoise, Decoy, DrawnLaw, Form, Further, Hiding, Place, Reads, Remembers, Rig, Secret, Truth,
    draw, record_asked,
};
use smam::identify::{RecordedRun, replay};
use smam::recording::{Channel, Recording, Run};
use smam::scene::Override;

/// The truth of a stock rig without noise that hides so much.
fn quiet(rig: Rig, secrets: Vec<Secret>) -> Truth {
    let truth = draw("quiet", rig, Hiding::Nothing, 7).expect("a stock rig").truth;
    let noise = truth.noise.iter().map(|_| ChannelNoise::white(0.0)).collect();
    Truth { noise, secrets, calibration: Calibration::STOCK, decoys: Vec::<Decoy>::new(), ..truth }
}

/// Eight seconds of slow motion within the stroke of a rig.
fn programme(rig: Rig) -> Recording {
    let time_s: Vec<f64> = (0..=800).map(|k| f64::from(k) * 0.01).collect();
    let wave = |high: f64| -> Vec<f64> { time_s.iter().map(|t| high * (0.5 - 0.5 * (0.9 * t).cos())).collect() };
    let strokes_mm: &[f64] = match rig {
        Rig::MuscleBench => &[2.5],
        Rig::AntagonisticPulley => &[-0.7, 0.7],
        Rig::BendingCatheter => &[-1.0, -0.5],
    };
    let channels = rig.inputs().iter().zip(strokes_mm).map(|(column, mm)| Channel::new(*column, wave(*mm))).collect();
    Recording::new(time_s, channels).expect("increasing")
}

fn played(rig: Rig, secrets: Vec<Secret>) -> Recording {
    record_asked(&quiet(rig, secrets), &programme(rig), None, Further::default()).expect("the plant runs")
}

fn simulated(rig: Rig, law: Option<String>, recorded: &Recording) -> Recording {
    let run = RecordedRun { run: Run { file: "made".to_owned(), ..Run::default() }, recording: recorded.clone() };
    let sets: Vec<Override> =
        law.iter().map(|table| Override::parse(&format!("law.hidden={{{table}}}")).expect("an override")).collect();
    replay(rig.scene(), &sets, &run, 1).unwrap_or_else(|e| panic!("{sets:?}: {e}"))
}

/// Greatest difference of an output.
fn apart(a: &Recording, b: &Recording, column: &str) -> f64 {
    let values = |r: &Recording| r.channel(column).expect("shown").values.clone();
    values(a).iter().zip(values(b)).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}

const fn law(place: Place, reads: Reads, scale: f64, form: Form) -> DrawnLaw {
    DrawnLaw { place, reads: Some(reads), scale, form, remembers: Remembers::Nothing, times: None }
}

#[test]
fn the_plant_and_the_scene_agree_on_every_law() {
    use Place as P;
    use Reads as R;
    let over = |place, reads, scale| law(place, reads, scale, Form::SignedPower(1.0));
    let bench = [
        (over(P::Wall, R::Elongation, 0.01), 0.3),
        (over(P::Coil, R::Elongation, 0.01), 0.5),
        (law(P::Friction, R::Elongation, 0.01, Form::Decays(1.2)), 0.5),
        (law(P::Damping, R::Elongation, 0.01, Form::Logarithm(2.0)), 4.0),
        (over(P::Area, R::Elongation, 0.01), 0.1),
        (law(P::Pull, R::Pressure, 8e5, Form::Waves(1.2)), 0.05),
        (over(P::RestLength, R::Pressure, 8e5), 5e-4),
        (law(P::Resistance, R::Flow, 1e-8, Form::Power(1.4)), 4.0),
        (law(P::PressureDrop, R::Flow, 1e-8, Form::Saturates(2.0)), 1e5),
        (over(P::Outflow, R::Pressure, 8e5), 1e-10),
        (over(P::LineCompliance, R::Pressure, 8e5), 0.8),
        (over(P::SyringeCompliance, R::Pressure, 8e5), 0.4),
        (law(P::SyringeFlow, R::Pressure, 8e5, Form::Beyond { from: 0.5, power: 1.3 }), 1e-10),
        (DrawnLaw { remembers: Remembers::Lag(2.0), ..over(P::Wall, R::Elongation, 0.01) }, 0.3),
        (DrawnLaw { remembers: Remembers::TwoLags(1.0), ..over(P::Pull, R::Elongation, 0.01) }, 0.05),
        (DrawnLaw { remembers: Remembers::Greatest, ..over(P::Coil, R::Elongation, 0.01) }, 0.4),
        (DrawnLaw { remembers: Remembers::Falling(0.4), ..over(P::Wall, R::Elongation, 0.01) }, 0.3),
        (DrawnLaw { times: Some((R::Pressure, 8e5)), ..over(P::Pull, R::Elongation, 0.01) }, 0.03),
    ];
    let pulley = [
        (over(P::CableStiffness, R::Tension, 0.6), 0.5),
        (over(P::Lever, R::Angle, 0.3), 0.1),
        (law(P::Transmission, R::Angle, 0.3, Form::Bump { at: 0.5, width: 0.8 }), -0.2),
        (over(P::Torque, R::Angle, 0.3), -3e-4),
        (law(P::JointDamping, R::AngularSpeed, 0.3, Form::Power(1.0)), 400.0),
        (DrawnLaw { reads: None, ..law(P::Wall, R::Elongation, 0.01, Form::Constant) }, 0.2),
    ];
    let catheter = [(over(P::JointStiffness, R::Angle, 0.3), 0.4), (over(P::Torque, R::Angle, 0.3), -1e-4)];
    let of = |rig: Rig, laws: &[(DrawnLaw, f64)]| -> Vec<(Rig, DrawnLaw, f64)> {
        laws.iter().map(|(law, size)| (rig, *law, *size)).collect()
    };
    let all = [of(Rig::MuscleBench, &bench), of(Rig::AntagonisticPulley, &pulley), of(Rig::BendingCatheter, &catheter)];
    let plain = Rig::ALL.map(|rig| played(rig, Vec::new()));
    let without: Vec<Recording> = Rig::ALL.iter().zip(&plain).map(|(rig, r)| simulated(*rig, None, r)).collect();
    let mut wrong = Vec::new();
    for (rig, law, size) in all.concat() {
        let hiding = played(rig, vec![Secret { size, ..law.secret(rig, 0, 1.0) }]);
        let table = law.table(rig, 0, size);
        let with = simulated(rig, Some(table.trim_end().replace('\n', ", ")), &hiding);
        let (plain, without) = (&plain[rig as usize], &without[rig as usize]);
        for output in rig.outputs() {
            // How far the programs are apart without a law is theirs; what the law changes must be the same.
            let (shown, own) = (apart(plain, &hiding, output.column), apart(plain, without, output.column));
            let left = apart(&hiding, &with, output.column);
            if left > 0.02 * shown + 2.0 * own + 0.2 * output.noise_sd {
                wrong.push(format!("{table}{}: {left:.4} of {shown:.4}, without {own:.4}", output.column));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
