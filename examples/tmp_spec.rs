use smam::effects::EffectTable;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let t = EffectTable {
        name: a[2].clone(),
        element: a[3].clone(),
        channel: None,
        parameters: [(a[4].clone(), a[5].parse::<f64>().unwrap())].into_iter().collect(),
    };
    let e = t.effect().unwrap();
    let p = std::path::Path::new(&a[7]);
    std::fs::create_dir_all(p).unwrap();
    smam::trial::make_specimen(&a[1], Some(&e), a[8].parse().unwrap(), a[6].parse().unwrap(), p).unwrap();
}
