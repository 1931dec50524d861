use translator::{comparison, parse_configuration};
#[test]
fn gallery() {
    for name in ["paper", "lift", "traffic_light", "infusion", "rover", "inspection", "../../autopilot/agent/autopilot"] {
        let path = format!("../translator/agents/{name}");
        let configuration = std::fs::read_to_string(format!("{path}.conf")).unwrap();
        let text = std::fs::read_to_string(format!("{path}.asl")).unwrap();
        let configuration = parse_configuration("a.conf", &configuration).unwrap();
        let compared = comparison(&configuration, &text).unwrap();
        let c = &compared.files[0].text;
        match judged_c::judge(&compared, c, &[]) {
            Ok(judged) => {
                let strip = |text: &str| {
                    let mut out = String::new();
                    let mut rest = text;
                    while let Some(at) = rest.find("/*") {
                        out.push_str(&rest[..at]);
                        rest = &rest[at + 2..];
                        rest = &rest[rest.find("*/").unwrap() + 2..];
                    }
                    out.push_str(rest);
                    out.split_whitespace().collect::<Vec<_>>().join(" ")
                };
                let (a, b) = (strip(c), strip(judged.text()));
                let at = a.bytes().zip(b.bytes()).position(|(a, b)| a != b);
                assert_eq!(a, b, "{name} {at:?}");
            }
            Err(error) => panic!("{name}: {error}: {}", c.lines().nth(error.line as usize - 1).unwrap_or("")),
        }
    }
}
