// A style sheet as a text, for the bundle of the plot.
declare module "*.css" {
  const text: string;
  export default text;
}
