//! Random combiners, legal or not.

use ninebit::state::*;
use proptest::prelude::*;

fn of<T: Named + std::fmt::Debug>() -> impl Strategy<Value = T> {
    (0..T::ALL.len()).prop_map(|n| T::ALL[n])
}

fn input() -> impl Strategy<Value = CombinerInput> {
    let plain = Just(CombinerInput::zero(Component::Rgb));
    let any =
        (of(), of(), of()).prop_map(|(register, component, mapping)| CombinerInput { register, component, mapping });
    prop_oneof![1 => plain, 1 => Just(CombinerInput::zero(Component::Alpha)), 6 => any]
}

fn output() -> impl Strategy<Value = Register> {
    prop_oneof![Just(Register::Zero), of()]
}

fn portion() -> impl Strategy<Value = Portion> {
    let flags = prop::array::uniform5(any::<bool>());
    (prop::array::uniform4(input()), prop::array::uniform3(output()), flags, of(), of()).prop_map(
        |(inputs, [ab_output, cd_output, sum_output], [ab_dot_product, cd_dot_product, mux, ab, cd], scale, bias)| {
            Portion {
                inputs,
                ab_output,
                cd_output,
                sum_output,
                ab_dot_product,
                cd_dot_product,
                mux,
                scale,
                bias,
                ab_blue_to_alpha: ab,
                cd_blue_to_alpha: cd,
            }
        },
    )
}

fn constants() -> impl Strategy<Value = [[u8; 4]; 2]> {
    prop_oneof![Just([[0; 4]; 2]), Just([[255, 0, 0, 255]; 2]), any::<[[u8; 4]; 2]>()]
}

fn half(component: Component) -> impl Strategy<Value = Portion> {
    prop_oneof![1 => Just(Portion::idle(component)), 5 => portion()]
}

fn stage() -> impl Strategy<Value = GeneralStage> {
    (half(Component::Rgb), half(Component::Alpha), constants()).prop_map(|(rgb, alpha, constants)| GeneralStage {
        rgb,
        alpha,
        constants,
    })
}

fn final_input() -> impl Strategy<Value = FinalInput> {
    let any = (of(), of(), any::<bool>()).prop_map(|(register, component, invert)| FinalInput {
        register,
        component,
        invert,
    });
    prop_oneof![2 => Just(FinalInput::zero(Component::Rgb)), 3 => any]
}

/// Returns combiners with up to nine stages, in which every field is arbitrary.
pub fn combiners() -> BoxedStrategy<Combiners> {
    let final_combiner =
        (
            [final_input(), final_input(), final_input(), final_input(), final_input(), final_input()],
            final_input(),
            any::<[bool; 3]>(),
            constants(),
        )
            .prop_map(|(inputs, g, [color_sum_clamp, invert_spare0, invert_secondary], constants)| {
                FinalCombiner { inputs, g, color_sum_clamp, invert_spare0, invert_secondary, constants }
            });
    (prop::collection::vec(stage(), 0..10), of(), final_combiner)
        .prop_map(|(stages, mux_select, final_combiner)| Combiners { stages, mux_select, final_combiner })
        .boxed()
}
